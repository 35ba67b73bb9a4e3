#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

// What encloses points.
namespace splatscope::kernels {

// Along the axes; of nothing: low = INFINITY, high = -INFINITY.
struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};

  void add(const glm::dvec3& place) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  // All within `reach` of `place` along each axis.
  void add(const glm::dvec3& place, const glm::dvec3& reach) {
    add(place - reach);
    add(place + reach);
  }
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  glm::dvec3 size() const { return high - low; }
  // 0 to 7; i and 7 - i are opposite.
  glm::dvec3 corner(std::size_t i) const {
    return {(i & 1 ? high : low).x, (i & 2 ? high : low).y, (i & 4 ? high : low).z};
  }
};

struct Sphere {
  glm::dvec3 center{};
  double radius = 0;
};

// About the middle of the box of the items' positions, with all that an item reaches, reach(item), about its
// own. At least one item.
template <class Items, class Reach>
Sphere bounding_sphere(const Items& items, const Reach& reach) {
  Box box;
  for (const auto& item : items) box.add(glm::dvec3(item.position));
  Sphere sphere{box.middle(), 0};
  for (const auto& item : items) {
    const double furthest = glm::distance(glm::dvec3(item.position), sphere.center) + reach(item);
    sphere.radius = std::max(sphere.radius, furthest);
  }
  return sphere;
}

}  // namespace splatscope::kernels
