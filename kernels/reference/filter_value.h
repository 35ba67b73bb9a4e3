#pragma once

#include <glm/vec2.hpp>

#include "kernels/object_space_ewa/alpha_texture.h"

// The unit Gaussian of a splat with its cutoff.
namespace splatscope::kernels {

struct ReferenceSettings {
  bool prefilter = true;  // false: V_r alone, the plain algorithm
  double cutoff = 1.0;    // c of Eq. 14
  CutoffShape shape = CutoffShape::square;
};

// The largest coordinate of y within the cutoff.
double filter_reach(const ReferenceSettings& settings);

// exp(-y.y/2), and 0 beyond the cutoff.
double filter_value(const ReferenceSettings& settings, const glm::dvec2& y);

}  // namespace splatscope::kernels
