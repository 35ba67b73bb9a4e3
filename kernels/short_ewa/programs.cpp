#include "kernels/short_ewa/programs.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "kernels/vec4.h"

namespace splatscope::kernels {
namespace {

// Of near^2, added to z^2: a surfel at the eye keeps a finite 1/z, and one at the near plane loses 5e-10 of
// it, which is far less than a float holds: what is lost would move its depth, by as many near^2.
constexpr double kDepthFloor = 1e-9;
// Of the second pivot of W, (z/r)^2 or more but for rounding: r is a thousand times z before this floor
// shows.
constexpr double kSmallestPivot = 1e-6;

}  // namespace

std::vector<Vec4> plane_constants(const View& view, double cutoff, double) {
  // A uniform scale of the camera space changes no picture: with unit rows it is that of the object.
  const double scale = glm::length(glm::dvec3(view.object_to_camera[0]));
  const glm::dmat4 rows = glm::transpose(view.object_to_camera) / scale;
  const glm::dvec4 eye = glm::inverse(view.object_to_camera) * glm::dvec4(0, 0, 0, 1);
  const double near = view.near_plane / scale;
  const double depth = view.depth_scale();
  const double radius = std::sqrt(2.0 * cutoff);
  const double eta_squared = view.eta * view.eta;
  return {vec4(view.eta * rows[0]),
          vec4(view.eta * rows[1]),
          vec4(rows[2]),
          vec4(eta_squared * eye),
          vec4({2.0 / view.width, 2.0 / view.height, -depth * near, 1.0}),
          vec4({0.0, -1.0 / near - 1.0, eta_squared, kDepthFloor * near * near}),
          vec4({kSmallestPivot, 0.0, 0.0, 0.0}),
          vec4({-1.0, -eta_squared, 0.0, 0.0}),
          vec4({2.0 * radius, -radius, 1.0, 0.0})};
}

}  // namespace splatscope::kernels
