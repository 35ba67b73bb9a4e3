#pragma once

#include <glm/vec2.hpp>

#include "kernels/object_space_ewa/alpha_texture.h"

// The unit Gaussian of a splat with its cutoff: exactly, and as a machine may see it.
namespace splatscope::kernels {

struct ReferenceSettings {
  bool prefilter = true;  // false: V_r alone, the plain algorithm
  double cutoff = 1.0;    // c of Eq. 14
  CutoffShape shape = CutoffShape::square;
  // A splat whose cutoff passes a pixel's centre this close, in units of y, may count there or not. A texel
  // of an alpha texture of size len is 2 sqrt(2c)/len.
  double cutoff_tolerance = 0.0;
  // The same for the edges of its parallelogram, which a rasteriser moves to its grid: they touch a circular
  // cutoff at four points. With the prefilter, one pixel moves y by at most 1.
  double edge_tolerance = 0.0;
  // Size of an 8-bit alpha texture whose texel nearest to y is the splat's value, where y is known to
  // cutoff_tolerance; 0: the value is exp(-y.y/2).
  int texture_length = 0;
};

// exp(-y.y/2), and 0 beyond the cutoff. Tolerances and texture do not count.
double filter_value(const ReferenceSettings& settings, const glm::dvec2& y);

// The values, from `low` to `high`, that a splat may have at y: 0 and the Gaussian's where a cutoff or an
// edge is within its tolerance, or those of every texel that may be the nearest.
struct FilterRange {
  double low = 0;
  double high = 0;
};
FilterRange filter_range(const ReferenceSettings& settings, const glm::dvec2& y);

// The largest coordinate of y at which filter_range may not be 0.
double filter_reach(const ReferenceSettings& settings);

}  // namespace splatscope::kernels
