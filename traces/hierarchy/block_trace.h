#pragma once

#include <span>
#include <vector>

#include "traces/hierarchy/block_choice.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {

// The levels that frames draw, the finest first.
std::vector<std::size_t> levels_of(std::span<const ChosenFrame> frames);

// The frames as a trace. The levels that they draw lie in vertex buffers of kSurfelsADraw surfels each, in
// their order: a surfel's number says its buffer and its place in there (Ren 2002, section 6.2). `weights`:
// of each level that is drawn, a weight for each of its surfels. `still_weights`: of each level, that of the
// frame that refines.
Trace block_trace(const LdcTree& tree, std::span<const ChosenFrame> frames,
                  std::span<const std::vector<VertexWeights>> weights, std::span<const double> still_weights,
                  const kernels::View& view, const Splatting& splatting, const SplatPass& pass);

}  // namespace splatscope::traces
