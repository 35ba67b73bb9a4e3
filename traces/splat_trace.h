#pragma once

#include <span>

#include "kernels/view.h"
#include "model/command/commands.h"
#include "traces/scene.h"

namespace splatscope::traces {

// How the second pass splats.
struct SplatPass {
  std::span<const float> weights;  // s_k, one a surfel
  bool prefilter = true;           // EWA; false: the reconstruction filter alone
  bool sum_weights = false;  // true: the alpha channel sums the weights; false: it is left to the blend unit
};

// The scene's camera and frame as the programs need them.
kernels::View view_of(const Camera& camera, const Frame& frame);

// The orthogonal tangents of a surfel, scaled by its radius h: the axes of its parameterisation.
struct Tangents {
  glm::dvec3 s, t;
};
Tangents tangents(const Surfel& surfel);

// Buffers, programs and draws of the two passes of Ren 2002, section 5, over all surfels: clear, visibility,
// splats. Four vertices a surfel in `settings.vertex_memory`, six 16-bit indices a surfel shared by all
// draws.
Trace splat_trace(std::span<const Surfel> surfels, const kernels::View& view, const Splatting& settings,
                  const SplatPass& pass);

}  // namespace splatscope::traces
