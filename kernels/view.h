#pragma once

#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace splatscope::kernels {

// The pinhole camera of Ren 2002, section 5.2. Object and camera space are Direct3D's: left-handed, in camera
// space x right, y up, z into the screen. Window coordinates are in pixels from the upper left corner; pixel
// (i, j) has its centre at (i + 0.5, j + 0.5).
struct View {
  glm::dmat4 object_to_camera{1.0};  // uniform scaling, rotation and translation only (Eq. 9)
  int width = 0;                     // pixels
  int height = 0;
  double eta = 0;         // Eq. 10: pixels per unit of x/z and y/z
  double near_plane = 0;  // camera z of the clip planes, 0 < near < far
  double far_plane = 0;

  glm::dvec3 camera_space(const glm::dvec3& object_point) const {
    return glm::dvec3(object_to_camera * glm::dvec4(object_point, 1.0));
  }
  glm::dvec3 camera_direction(const glm::dvec3& object_vector) const {
    return glm::dmat3(object_to_camera) * object_vector;
  }
  // c0 and c1 of Eq. 10. Direct3D 8 has pixel centres at integers, the rasteriser at halves: half a pixel
  // more than the middle of the frame.
  glm::dvec2 center() const { return {0.5 * width + 0.5, 0.5 * height + 0.5}; }
  // Eq. 10. `p` in camera space, p.z > 0.
  glm::dvec2 window(const glm::dvec3& p) const {
    return center() + glm::dvec2(eta * p.x / p.z, -eta * p.y / p.z);
  }
  // Camera z of the point at camera z `z` of a pixel's ray, moved away from the eye by z_t (Ren 2002, 5.1).
  double moved_back(double z, int column, int row, double z_t) const {
    const glm::dvec2 ray = (glm::dvec2(column, row) + 0.5 - center()) / eta;
    return z + z_t / std::sqrt(ray.x * ray.x + ray.y * ray.y + 1);
  }
  // What 1 - near/z is multiplied by to be a depth in the frustum.
  double depth_scale() const { return far_plane / (far_plane - near_plane); }
  // Camera z of a depth in the frustum: 0 at the near plane, 1 at the far plane.
  double z_of(double depth) const { return near_plane / (1 - depth * (far_plane - near_plane) / far_plane); }
};

// Eq. 10, for a field of view of a frame's height.
double eta_of(double fov_y_degrees, int height);

// A view from `eye` to `target` with `up` upward in the picture; the field of view is that of the frame's
// height, in degrees, in (0, 180). eye != target, and `up` not along the line of sight.
View look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up, double fov_y_degrees,
             int width, int height, double near_plane, double far_plane);

}  // namespace splatscope::kernels
