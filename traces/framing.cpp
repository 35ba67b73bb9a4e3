#include "traces/framing.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

#include "kernels/bounds.h"

namespace splatscope::traces {
namespace {

constexpr glm::dvec3 kFrom{0.55, 0.4, 1};  // direction from the target to the eye
constexpr double kFieldOfView = 30;        // degrees
constexpr double kFilled = 0.95;           // of half the frame's width or height
constexpr double kClosest = 1e-3;          // near plane, in units of the far plane's distance

// Axes of a camera: right, up, ahead.
struct Axes {
  glm::dvec3 right, up, ahead;
  Axes(const glm::dvec3& direction, const glm::dvec3& up_hint) {
    ahead = glm::normalize(direction);
    right = glm::cross(ahead, up_hint);
    if (!(glm::length(right) > 1e-9 * glm::length(up_hint)))  // `up` along the line of sight is refused later
      right = glm::cross(ahead, std::abs(ahead.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
    right = glm::normalize(right);
    up = glm::cross(right, ahead);
  }
  glm::dvec3 of(const glm::dvec3& v) const {
    return {glm::dot(v, right), glm::dot(v, up), glm::dot(v, ahead)};
  }
};

// Distance from the target at which all surfels are within the frame.
double fitting_distance(std::span<const Surfel> surfels, const Axes& axes, const glm::dvec3& target,
                        const glm::dvec2& tangent) {
  double distance = 0;
  for (const Surfel& s : surfels) {
    const glm::dvec3 p = axes.of(glm::dvec3(s.position) - target);
    const double across = std::abs(p.x) + s.radius, high = std::abs(p.y) + s.radius;
    distance = std::max(distance, std::max(across / tangent.x, high / tangent.y) - p.z);
  }
  return distance;
}

}  // namespace

double corner_reach(const Splatting& splatting) {
  return std::max(std::numbers::sqrt2, 2 * splatting.sigma * std::sqrt(splatting.cutoff));
}

void frame_camera(std::span<const Surfel> surfels, double reach, const FrameSize& frame,
                  const CameraKeys& given, Camera& camera) {
  if (surfels.empty()) return;
  if (!given.up) camera.up = {0, 1, 0};
  if (!given.fov_y_degrees) camera.fov_y_degrees = kFieldOfView;
  kernels::Box box;
  for (const Surfel& s : surfels) box.add(glm::dvec3(s.position));
  if (!given.target) camera.target = box.middle();
  if (!given.eye) {
    const Axes axes(-kFrom, camera.up);
    if (!given.target) {  // the middle of what is seen, not of the box
      kernels::Box seen;
      for (const Surfel& s : surfels) seen.add(axes.of(glm::dvec3(s.position) - camera.target));
      camera.target += seen.middle().x * axes.right + seen.middle().y * axes.up;
    }
    const double tangent = kFilled * std::tan(camera.fov_y_degrees * std::numbers::pi / 360);
    const double distance =
        fitting_distance(surfels, axes, camera.target, {tangent * frame.width / frame.height, tangent});
    camera.eye = camera.target - (distance > 0 ? distance : 1) * axes.ahead;
  }
  if (glm::length(camera.target - camera.eye) == 0) return;  // refused later
  const Axes axes(camera.target - camera.eye, camera.up);
  double nearest = std::numeric_limits<double>::infinity(), furthest = 0;
  for (const Surfel& s : surfels) {
    const double depth = axes.of(glm::dvec3(s.position) - camera.eye).z;
    const double corner = std::max(2.0, reach) * s.radius;
    nearest = std::min(nearest, depth - corner);
    furthest = std::max(furthest, depth + corner);
  }
  if (!given.far) camera.far = furthest > 0 ? furthest : 1;  // 0: all of them behind the eye
  if (!given.near) camera.near = std::max(nearest, kClosest * camera.far);
}

}  // namespace splatscope::traces
