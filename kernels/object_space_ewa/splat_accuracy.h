#pragma once

#include <cstdint>

#include "kernels/object_space_ewa/quad_runner.h"

namespace splatscope::kernels {

// How far a vertex program is at most from the double-precision filter.
struct SplatErrors {
  double deviation = 0;      // relative, of the standard deviation in every direction of the screen
  double corner = 0;         // pixels, by the affine map J
  double window_corner = 0;  // pixels, by the projection
  double weight = 0;         // relative, of 1/(2 pi r0 r1)
  int corners_compared = 0;
};

// Rot(theta) Lambda as the corners of a quad show it, in units of s and t: where they are (tangent_plane) by
// where in the Gaussian (gaussian_coordinates).
glm::dmat2 measured_axes(const std::array<glm::dvec2, 4>& corners, const std::array<glm::dvec2, 4>& y);

// Largest relative deviation, over every direction of the screen, of the standard deviation by `measured`
// from that by `exact`.
double deviation_error(const glm::dmat2& measured, const glm::dmat2& exact);

// Over `count` random surfels before test_view(). Programs but paper and plain may draw any parallelogram of
// the right variance matrix.
SplatErrors splat_errors(const SplatProgram& program, Arithmetic arithmetic, std::uint32_t seed, int count,
                         const SurfelRanges& ranges = {});

}  // namespace splatscope::kernels
