#include "kernels/reference/volume/footprint.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace splatscope::kernels {
RaySpace ray_space(const View& view, Projection projection, const glm::dvec3& camera) {
  if (projection == Projection::orthographic) {
    RaySpace ray;
    ray.position = glm::dvec3(view.center() + view.eta * glm::dvec2(camera.x, -camera.y), camera.z);
    ray.jacobian = glm::dmat3(view.eta, 0, 0, 0, -view.eta, 0, 0, 0, 1);
    return ray;
  }
  const double distance = glm::length(camera), scale = view.eta / camera.z;
  RaySpace ray;
  ray.position = glm::dvec3(view.window(camera), distance);
  ray.jacobian[0] = {scale, 0, camera.x / distance};
  ray.jacobian[1] = {0, -scale, camera.y / distance};
  ray.jacobian[2] = {-scale * camera.x / camera.z, scale * camera.y / camera.z, camera.z / distance};
  return ray;
}

glm::dvec3 from_ray_space(const View& view, Projection projection, const glm::dvec3& ray) {
  const glm::dvec2 plane = (glm::dvec2(ray) - view.center()) / glm::dvec2(view.eta, -view.eta);
  if (projection == Projection::orthographic) return {plane, ray.z};
  return ray.z * glm::normalize(glm::dvec3(plane, 1.0));
}

double Footprint::radial_index(const glm::dvec2& x) const {
  const glm::dvec2 d = x - center;
  return glm::dot(d, conic * d);
}

double Footprint::value(const glm::dvec2& x) const {
  return peak * std::exp(-0.5 * radial_index(x));
}

glm::dvec2 Footprint::reach(double cutoff) const {
  return {std::sqrt(cutoff * variance[0][0]), std::sqrt(cutoff * variance[1][1])};
}

glm::dmat3 camera_variance(const View& view, const glm::dmat3& object_variance) {
  const glm::dmat3 w(view.object_to_camera);
  return w * object_variance * glm::transpose(w);
}

glm::dmat2 projected_variance(const RaySpace& ray, const glm::dmat3& camera_variance) {
  return glm::dmat2(ray.jacobian * camera_variance * glm::transpose(ray.jacobian));
}

glm::dmat2 prefiltered(VolumePrefilter prefilter, const glm::dmat2& variance) {
  if (prefilter == VolumePrefilter::none) return variance;
  if (prefilter == VolumePrefilter::ewa) return variance + glm::dmat2(1.0);
  const double half_trace = 0.5 * (variance[0][0] + variance[1][1]);
  const double larger = half_trace + std::hypot(0.5 * (variance[0][0] - variance[1][1]), variance[0][1]);
  const double smaller = glm::determinant(variance) / larger;
  return variance * std::max(1.0, 1 / smaller);
}

std::optional<Footprint> footprint(const View& view, Projection projection, VolumePrefilter prefilter,
                                   const glm::dvec3& camera, const glm::dmat3& camera_variance) {
  if (!(camera.z > view.near_plane && camera.z <= view.far_plane)) return std::nullopt;
  const RaySpace ray = ray_space(view, projection, camera);
  Footprint result{.center = glm::dvec2(ray.position), .distance = ray.position.z};
  result.variance = prefiltered(prefilter, projected_variance(ray, camera_variance));
  result.conic = glm::inverse(result.variance);
  const double volume_scale = std::abs(glm::determinant(ray.jacobian)) *
                              std::abs(glm::determinant(glm::dmat3(view.object_to_camera)));
  result.peak = volume_scale * 0.5 * std::numbers::inv_pi / std::sqrt(glm::determinant(result.variance));
  const double sum = result.center.x + result.center.y + result.conic[0][0] + result.conic[0][1] +
                     result.conic[1][1] + result.peak;
  if (!std::isfinite(sum)) return std::nullopt;
  return result;
}

double exact_integral(const View& view, Projection projection, const glm::dvec3& camera,
                      const glm::dmat3& camera_variance, const glm::dvec2& x) {
  // exp(-(a s^2 + 2 b s + c)/2) along start + s direction, s a length; from beside the kernel, for the sake
  // of rounding.
  const double distance = ray_space(view, projection, camera).position.z;
  const glm::dvec3 start = from_ray_space(view, projection, {x, distance});
  const glm::dvec3 direction = from_ray_space(view, projection, {x, distance + 1}) - start;
  const glm::dvec3 from_center = start - camera;
  const glm::dmat3 inverse = glm::inverse(camera_variance);
  const double a = glm::dot(direction, inverse * direction);
  const double b = glm::dot(direction, inverse * from_center);
  const double c = glm::dot(from_center, inverse * from_center);
  const double unit_integral = 0.5 * std::numbers::inv_pi / std::sqrt(a * glm::determinant(camera_variance));
  const double scale = std::abs(glm::determinant(glm::dmat3(view.object_to_camera)));
  return scale * unit_integral * std::exp(-0.5 * (c - b * b / a));
}

}  // namespace splatscope::kernels
