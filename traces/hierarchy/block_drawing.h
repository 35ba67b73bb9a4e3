#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernels/view.h"
#include "traces/hierarchy/ldc_tree.h"
#include "traces/splat_trace.h"

// From a tree to buffers and draws (Ren 2002, section 6.2).
namespace splatscope::traces {

// What became of the blocks of a frame.
struct BlockCounts {
  std::size_t drawn = 0;
  std::size_t outside_frustum = 0;
  std::size_t facing_away = 0;
  std::size_t surfels = 0;  // in the drawn blocks
};

// "412 blocks drawn, 7 outside the frustum, 390 facing away".
std::string describe(const BlockCounts& counts);

// A level's surfels in vertex buffers of kSurfelsADraw each, in their order: a surfel's number says its
// buffer and its place in there. The level and its weights must outlive the buffers.
std::vector<SurfelBuffer> pack(const TreeLevel& level, std::span<const VertexWeights> weights);

// What draws a frame of the finest level's blocks: those that `culling` leaves, in their order; neighbours
// are joined. Buffers as `pack` makes them.
std::vector<DrawnRange> draw_finest(const LdcTree& tree, const kernels::View& view, const Splatting& settings,
                                    Culling culling, BlockCounts& counts);

}  // namespace splatscope::traces
