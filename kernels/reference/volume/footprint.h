#pragma once

#include <cstdint>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "kernels/view.h"

// The EWA volume splat of Zwicker 2002, section 6.2, in double precision. glm matrices: [column][row].
namespace splatscope::kernels {

enum class Projection : std::uint8_t {
  perspective,
  orthographic  // eta pixels per unit of camera space, whatever z is
};

// How a footprint is kept from falling between the pixels.
enum class VolumePrefilter : std::uint8_t {
  ewa,   // convolved with a Gaussian of variance I (Eq. 33)
  swan,  // scaled alike in all directions until its smaller radius is that of the low-pass (Swan et al. 1997)
  none
};

// Ray space about a point: window coordinates in pixels, and the distance from the eye along the ray in
// camera units (Eq. 26, with the viewport transform).
struct RaySpace {
  glm::dvec3 position{};     // phi(t_k); z is camera z in an orthographic view
  glm::dmat3 jacobian{0.0};  // J_k (Eq. 29) in those units
};

// `camera` is t_k, with camera.z > 0 in perspective.
RaySpace ray_space(const View& view, Projection projection, const glm::dvec3& camera);

// Camera coordinates of a point of ray space (Eq. 27).
glm::dvec3 from_ray_space(const View& view, Projection projection, const glm::dvec3& ray);

// A kernel integrated along the rays and filtered: peak exp(-r/2) with r the radial index of section 7.1.
struct Footprint {
  glm::dvec2 center{};       // x_k, pixels
  double distance = 0;       // of x_k along its ray, camera units
  glm::dmat2 variance{0.0};  // V'_k + V_h, pixels squared
  glm::dmat2 conic{0.0};     // Q, its inverse
  double peak = 0;           // camera units of path by object units cubed: 1/(|J^-1||W^-1|) 1/(2 pi sqrt|V|)

  double radial_index(const glm::dvec2& x) const;  // r(x - x_k) = x^T Q x
  double value(const glm::dvec2& x) const;         // peak exp(-r/2)
  // Half the edges of the box about the ellipse r = cutoff, pixels.
  glm::dvec2 reach(double cutoff) const;
};

// W V W^T (Eq. 31): once a frame on grids, once a kernel elsewhere.
glm::dmat3 camera_variance(const View& view, const glm::dmat3& object_variance);

// Eq. 31 to 33 from the variance in camera space. Nothing where the point is not between the near and the
// far plane or the footprint not finite.
std::optional<Footprint> footprint(const View& view, Projection projection, VolumePrefilter prefilter,
                                   const glm::dvec3& camera, const glm::dmat3& camera_variance);

// V'_k of Eq. 31 without its third row and column (Eq. 24).
glm::dmat2 projected_variance(const RaySpace& ray, const glm::dmat3& camera_variance);

glm::dmat2 prefiltered(VolumePrefilter prefilter, const glm::dmat2& variance);

// The kernel integrated along the very ray of x, without the affine map or a low-pass: what Fig. 9 shows on
// its right. Camera units of path by object units cubed.
double exact_integral(const View& view, Projection projection, const glm::dvec3& camera,
                      const glm::dmat3& camera_variance, const glm::dvec2& x);

}  // namespace splatscope::kernels
