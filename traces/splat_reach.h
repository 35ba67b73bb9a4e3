#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "traces/scene.h"

// How far the quads of a surfel reach from its centre.
namespace splatscope::traces {

// A splat's corners, in standard deviations: sqrt 2 of the quad's half side, sqrt(2c).
inline double corner_deviations(const Splatting& splatting) {
  return 2 * std::sqrt(splatting.cutoff);
}

// Corners of the quads of either pass, before the low-pass filter, in radii of the surfel (Eq. 12 and 14).
inline double corner_reach(const Splatting& splatting) {
  return std::max(std::numbers::sqrt2, corner_deviations(splatting) * splatting.sigma);
}

// Largest axis of the low-pass filter, a pixel, on the plane of a surfel at camera z `z` > 0, object units:
// by the least singular value of J (Ren 2002, section 5.2), which is at least eta/z times the cosine between
// the normal and the ray.
inline double filter_length(double z, double eta, double cosine) {
  return z / (eta * cosine);
}

// Beyond it a splat, seen nearly edge-on, has no affine map that says where it goes.
inline double longest_filter(const Splatting& splatting, double z) {
  constexpr double kLongest = 0.25;  // of the distance: what the filter adds to the corners
  return kLongest * z / corner_deviations(splatting);
}

// Below this cosine a surfel counts as seen edge-on: the default clip planes are placed as if it were seen at
// this one, and no block with such surfels is culled by its cone.
inline constexpr double kEdgeOnCosine = 0.15;

// A bound for corners of either pass and any vertex program, object units; `filter`: its length.
inline double quad_reach(const Splatting& splatting, double radius, double filter) {
  // For the vertex programs whose parallelograms about the same ellipse differ by less, and for rounding.
  constexpr double kMargin = 1.5;
  const double splat = corner_deviations(splatting) * std::hypot(splatting.sigma * radius, filter);
  return kMargin * std::max(splat, std::numbers::sqrt2 * radius);
}

}  // namespace splatscope::traces
