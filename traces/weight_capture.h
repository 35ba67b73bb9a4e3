#pragma once

#include <functional>
#include <vector>

#include "model/number/formats.h"
#include "traces/scene.h"

namespace splatscope::traces {

struct CapturedWeights {
  std::vector<float> weights;  // s_k of every surfel, gamma folded in: multiplies its splat
  std::size_t captured = 0;    // surfels seen from at least one view; the others have the median of these
};

// Per-surfel normalisation weights (Ren 2002, section 7.2): the surfels are splatted without prefilter,
// scaled by gamma, from views spread evenly over the bounding sphere; where a surfel's projected centre is
// visible, the summed weights S read back from the alpha channel give s = 1/S; the median over the views
// counts, times gamma. A view that sees a surfel more edge-on than 60 degrees is not asked about it: its
// splat is then too thin to be sampled well (our choice; the paper says nothing). Frames of `formats` of the
// machine, 8 bits with its rounding.
CapturedWeights capture_weights(const Scene& scene, const NumberFormats& formats,
                                const std::function<void(double)>& progress = {});

}  // namespace splatscope::traces
