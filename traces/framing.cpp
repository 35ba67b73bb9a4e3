#include "traces/framing.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "kernels/bounds.h"
#include "kernels/view.h"
#include "traces/splat_reach.h"

namespace splatscope::traces {
namespace {

constexpr glm::dvec3 kFrom{0.55, 0.4, 1};  // direction from the target to the eye
constexpr double kFieldOfView = 30;        // degrees
constexpr double kFilled = 0.95;           // of half the frame's width or height
constexpr double kClosest = 1e-3;          // near plane, in units of the far plane's distance
// Of the depths' range, on either side: blocks of surfels are culled by their cones where boxes about them,
// which reach further than the surfels do, are within the planes.
constexpr double kRoom = 0.1;

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

void frame_camera(std::span<const Surfel> surfels, const FrameSize& frame, const CameraKeys& given,
                  Camera& camera) {
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
}

glm::dvec3 ahead_of(const Camera& camera) {
  const glm::dvec3 view = camera.target - camera.eye;
  const double length = glm::length(view);
  return length > 0 ? view / length : view;
}

DepthRange depths_of(std::span<const Surfel> surfels, const Splatting& splatting, const FrameSize& frame,
                     const Camera& camera) {
  const glm::dvec3 ahead = ahead_of(camera);
  const double eta = kernels::eta_of(camera.fov_y_degrees, frame.height);
  DepthRange range;
  for (const Surfel& s : surfels) {
    const glm::dvec3 ray = glm::dvec3(s.position) - camera.eye;
    const double depth = glm::dot(ray, ahead);
    double reach = quad_reach(splatting, s.radius, 0);  // behind the eye, where no pixel is
    if (depth > 0) {
      const glm::dvec3 normal(s.normal);
      const double cosine = std::max(kEdgeOnCosine, std::abs(glm::dot(normal, ray)) / glm::length(ray));
      const double filter = std::min(filter_length(depth, eta, cosine), longest_filter(splatting, depth));
      const double along = glm::dot(normal, ahead);
      reach = quad_reach(splatting, s.radius, filter) * std::sqrt(std::max(0.0, 1 - along * along));
    }
    range.add(depth, std::max(2.0 * s.radius, reach));
  }
  const double between = range.furthest - range.nearest;
  const double room = kRoom * between;
  return {range.nearest - room, range.furthest + room + std::min(splatting.depth_offset, between)};
}

void place_planes(const DepthRange& depths, const CameraKeys& given, Camera& camera) {
  if (!given.far) camera.far = depths.furthest > 0 ? depths.furthest : 1;  // 0: all of it behind the eye
  if (!given.near) camera.near = std::max(depths.nearest, kClosest * camera.far);
}

void place_planes(Scene& scene, const CameraKeys& given) {
  place_planes(depths_of(scene.surfels, scene.splatting, scene.frame, scene.camera), given, scene.camera);
}

}  // namespace splatscope::traces
