#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "kernels/view.h"

namespace splatscope::kernels {

// A surfel as the vertex programs get it, in object units.
struct Surfel {
  glm::dvec3 position{};
  glm::dvec3 tangent_s{};  // s and t, at right angles, both of length h
  glm::dvec3 tangent_t{};
  double sigma = 1.0;   // standard deviation of the reconstruction filter, units of h: V_r = sigma^2 I
  double weight = 1.0;  // s_k of Eq. 17
  glm::dvec3 color{};   // w_k
};

// The filter of one surfel in its tangent plane; u in units of h. glm matrices: [column][row].
struct SurfelFilter {
  glm::dmat2 jacobian{};  // J_k of window coordinates by u (Ren 2002, section 5.2), pixels
  glm::dmat2 variance{};  // M_k (Eq. 7), or V_r without the prefilter
  glm::dmat2 axes{};  // Rot(theta) Lambda (Eq. 12): u = axes y. The larger axis first, and it is s where both
                      // are equal
  double determinant = 0;  // |M_k|; its root is r0 r1
};

// Ren 2002, Eq. 7 and 11. Nothing for a surfel that has no local affine map: at or before the near plane, or
// whose plane holds the eye (|J| = 0 in double).
std::optional<SurfelFilter> surfel_filter(const View& view, const Surfel& surfel, bool prefilter);

}  // namespace splatscope::kernels
