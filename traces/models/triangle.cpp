#include "traces/models/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace splatscope::traces {
namespace {

// Whether a plane perpendicular to `axis` lies between the triangle and the box about the origin.
bool separates(const glm::dvec3& axis, const Triangle& t, const glm::dvec3& half_size) {
  const double a = glm::dot(axis, t[0]), b = glm::dot(axis, t[1]), c = glm::dot(axis, t[2]);
  const double reach = glm::dot(glm::abs(axis), half_size);
  const double rounding = 1e-12 * (reach + std::abs(a) + std::abs(b) + std::abs(c));
  return std::min({a, b, c}) > reach + rounding || std::max({a, b, c}) < -reach - rounding;
}

}  // namespace

bool overlaps(const Triangle& triangle, const glm::dvec3& center, const glm::dvec3& half_size) {
  const Triangle t{triangle[0] - center, triangle[1] - center, triangle[2] - center};
  const glm::dvec3 edges[] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  constexpr glm::dvec3 kAxes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const glm::dvec3& axis : kAxes)
    if (separates(axis, t, half_size)) return false;
  if (separates(glm::cross(edges[0], edges[1]), t, half_size)) return false;
  for (const glm::dvec3& edge : edges)
    for (const glm::dvec3& axis : kAxes)
      if (separates(glm::cross(axis, edge), t, half_size)) return false;
  return true;
}

// By the regions in which a point may lie: nearest to a corner, to an edge, or inside (Ericson, Real-Time
// Collision Detection, 5.1.5).
glm::dvec3 closest_point(const Triangle& t, const glm::dvec3& point) {
  const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0];
  const glm::dvec3 from_a = point - t[0], from_b = point - t[1], from_c = point - t[2];
  const double a_ab = glm::dot(ab, from_a), a_ac = glm::dot(ac, from_a);
  if (a_ab <= 0 && a_ac <= 0) return {1, 0, 0};
  const double b_ab = glm::dot(ab, from_b), b_ac = glm::dot(ac, from_b);
  if (b_ab >= 0 && b_ac <= b_ab) return {0, 1, 0};
  const double area_c = a_ab * b_ac - b_ab * a_ac;
  if (area_c <= 0 && a_ab >= 0 && b_ab <= 0) {
    const double along = a_ab / (a_ab - b_ab);
    return {1 - along, along, 0};
  }
  const double c_ab = glm::dot(ab, from_c), c_ac = glm::dot(ac, from_c);
  if (c_ac >= 0 && c_ab <= c_ac) return {0, 0, 1};
  const double area_b = c_ab * a_ac - a_ab * c_ac;
  if (area_b <= 0 && a_ac >= 0 && c_ac <= 0) {
    const double along = a_ac / (a_ac - c_ac);
    return {1 - along, 0, along};
  }
  const double area_a = b_ab * c_ac - c_ab * b_ac;
  const double toward_c = b_ac - b_ab, toward_b = c_ab - c_ac;
  if (area_a <= 0 && toward_c >= 0 && toward_b >= 0) {
    const double along = toward_c / (toward_c + toward_b);
    return {0, 1 - along, along};
  }
  const double sum = area_a + area_b + area_c;
  if (!(sum > 0)) return {1, 0, 0};  // a sliver whose area is lost to rounding
  return {1 - area_b / sum - area_c / sum, area_b / sum, area_c / sum};
}

}  // namespace splatscope::traces
