#include "kernels/reference/ray_plane.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace splatscope::kernels {
namespace {

PixelBox box_between(const View& view, const glm::dvec2& low, const glm::dvec2& high) {
  const auto pixel = [](double coordinate, int size) {
    return coordinate > 0 ? static_cast<int>(std::min(coordinate, double(size))) : 0;  // NaN: 0
  };
  return {pixel(low.x, view.width), pixel(low.y, view.height), pixel(high.x + 1, view.width),
          pixel(high.y + 1, view.height)};
}

}  // namespace

PixelBox bounding_box(const View& view, const glm::dvec3& o, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 corners[4] = {o - a - b, o + a - b, o + a + b, o - a + b};
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high(-std::numeric_limits<double>::infinity());
  const auto add = [&](const glm::dvec3& p) {
    const glm::dvec2 window = view.window(p);
    low = glm::min(low, window);
    high = glm::max(high, window);
  };
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3& p = corners[i];
    const glm::dvec3& next = corners[(i + 1) % 4];
    const double before = p.z - view.near_plane;
    const double after = next.z - view.near_plane;
    if (before >= 0) add(p);
    if ((before < 0) != (after < 0)) add(p + (next - p) * (before / (before - after)));
  }
  return box_between(view, low, high);
}

PixelBox box_about(const View& view, const glm::dvec2& center, const glm::dvec2& reach) {
  return box_between(view, center - reach, center + reach);
}

RayPlane::RayPlane(const View& view, const glm::dvec3& o, const glm::dvec3& a, const glm::dvec3& b)
    : denominator_(view, glm::cross(a, b)),
      numerator0_(view, glm::cross(b, o)),
      numerator1_(view, glm::cross(o, a)),
      plane_(glm::dot(o, glm::cross(a, b))) {}

}  // namespace splatscope::kernels
