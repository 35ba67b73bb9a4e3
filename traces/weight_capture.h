#pragma once

#include <functional>
#include <span>
#include <vector>

#include "model/number/formats.h"
#include "traces/scene.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {

struct CapturedWeights {
  std::vector<VertexWeights> weights;  // s_k of every surfel, gamma folded in: multiplies its splat
  // Every surfel is one of these three.
  std::size_t captured = 0;     // seen from at least one view
  std::size_t unseen = 0;       // seen from none: they have the median of the captured ones
  std::size_t outside_box = 0;  // of the capture: they have gamma, as the capture itself draws them
  std::size_t at_edges = 0;     // captured, with a weight for each vertex
};

// Per-surfel normalisation weights (Ren 2002, section 7.2): the surfels are splatted without prefilter,
// scaled by gamma, from views spread evenly over the bounding sphere; where a surfel's projected centre is
// visible, the summed weights S read back from the alpha channel give s = 1/S; the median over the views
// counts, times gamma. A view that sees a surfel more edge-on than 60 degrees is not asked about it: its
// splat is then too thin to be sampled well (our choice; the paper says nothing). At an edge of the model
// (edges.h) the same is done at each vertex of the quad. Frames of `formats` of the machine, 8 bits with its
// rounding. Views are drawn in parallel; the result does not depend on how many at a time.
CapturedWeights capture_weights(std::span<const Surfel> surfels, const Splatting& splatting,
                                const Capture& capture, const NumberFormats& formats,
                                const std::function<void(double)>& progress = {});
// Those of a scene.
CapturedWeights capture_weights(const Scene& scene, const NumberFormats& formats,
                                const std::function<void(double)>& progress = {});

// The same for each of so many surfels: nothing is captured.
CapturedWeights uniform_weights(std::size_t surfels, double weight);

}  // namespace splatscope::traces
