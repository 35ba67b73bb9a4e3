#include "kernels/reference/surfel_filter.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace splatscope::kernels {
namespace {

glm::dmat2 jacobian(const View& view, const Surfel& surfel) {
  const glm::dvec3 o = view.camera_space(surfel.position);
  const auto column = [&](const glm::dvec3& object_tangent) {
    const glm::dvec3 s = view.camera_direction(object_tangent);
    return view.eta / (o.z * o.z) * glm::dvec2(s.x * o.z - s.z * o.x, s.z * o.y - s.y * o.z);
  };
  return {column(surfel.tangent_s), column(surfel.tangent_t)};
}

// Columns: eigenvectors of the symmetric m, scaled by the roots of their eigenvalues, the larger first.
glm::dmat2 principal_axes(const glm::dmat2& m, double determinant) {
  const double half_difference = 0.5 * (m[0][0] - m[1][1]);
  const double distance = std::hypot(half_difference, m[0][1]);
  const double larger = 0.5 * (m[0][0] + m[1][1]) + distance;
  const double angle = 0.5 * std::atan2(m[0][1], half_difference);  // 0 where both arguments are 0
  const glm::dvec2 direction{std::cos(angle), std::sin(angle)};
  return {std::sqrt(larger) * direction,
          std::sqrt(determinant / larger) * glm::dvec2(-direction.y, direction.x)};
}

}  // namespace

std::optional<SurfelFilter> surfel_filter(const View& view, const Surfel& surfel, bool prefilter) {
  if (!(view.camera_space(surfel.position).z > view.near_plane)) return std::nullopt;
  SurfelFilter filter;
  filter.jacobian = jacobian(view, surfel);
  const double inverse = 1.0 / glm::determinant(filter.jacobian);
  if (!std::isfinite(inverse)) return std::nullopt;
  const double sigma_squared = surfel.sigma * surfel.sigma;
  filter.variance = glm::dmat2(sigma_squared);
  filter.determinant = sigma_squared * sigma_squared;
  if (prefilter) {
    const glm::dmat2 j = glm::inverse(filter.jacobian);
    const glm::dmat2 low_pass = j * glm::transpose(j);
    filter.variance += low_pass;
    // |V_r + N| written out: from the entries of M it would cancel for a surfel seen edge-on.
    filter.determinant += sigma_squared * (low_pass[0][0] + low_pass[1][1]) + inverse * inverse;
  }
  filter.axes = principal_axes(filter.variance, filter.determinant);
  return filter;
}

}  // namespace splatscope::kernels
