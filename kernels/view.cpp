#include "kernels/view.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace splatscope::kernels {

double eta_of(double fov_y_degrees, int height) {
  return height / (2.0 * std::tan(0.5 * glm::radians(fov_y_degrees)));
}

View look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up, double fov_y_degrees,
             int width, int height, double near_plane, double far_plane) {
  View view;
  view.object_to_camera = glm::lookAtLH(eye, target, up);
  view.width = width;
  view.height = height;
  view.eta = eta_of(fov_y_degrees, height);
  view.near_plane = near_plane;
  view.far_plane = far_plane;
  return view;
}

}  // namespace splatscope::kernels
