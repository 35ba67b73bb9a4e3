#include "traces/models/triangle.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace splatscope::traces {
namespace {

// What is left of a triangle within a box, by cutting along each face of it in turn (Sutherland-Hodgman).
bool something_inside(const Triangle& triangle, const glm::dvec3& center, const glm::dvec3& half) {
  std::vector<glm::dvec3> polygon(triangle.begin(), triangle.end());
  for (int face = 0; face < 6 && !polygon.empty(); ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 1 : -1;
    const auto inside = [&](const glm::dvec3& p) { return half[axis] - side * (p[axis] - center[axis]); };
    std::vector<glm::dvec3> cut;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double in_a = inside(a), in_b = inside(b);
      if (in_a >= 0) cut.push_back(a);
      if ((in_a >= 0) != (in_b >= 0)) cut.push_back(a + in_a / (in_a - in_b) * (b - a));
    }
    polygon = std::move(cut);
  }
  return !polygon.empty();
}

glm::dvec3 any_point(double reach) {
  const auto coordinate = [&] { return reach * (*rc::gen::inRange(-1000000, 1000001)) * 1e-6; };
  const double x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

Triangle any_triangle(double reach) {
  const glm::dvec3 a = any_point(reach), b = any_point(reach), c = any_point(reach);
  return {a, b, c};
}

RC_GTEST_PROP(Triangle, OverlapsABoxWhereCuttingLeavesSomething, ()) {
  const Triangle t = any_triangle(*rc::gen::element(1.0, 2.0, 6.0));
  const glm::dvec3 center = any_point(0.5);
  const glm::dvec3 half = glm::abs(any_point(1)) + 1e-3;
  const bool more = something_inside(t, center, half + 1e-9), less = something_inside(t, center, half - 1e-9);
  RC_PRE(more == less);  // not just touching
  RC_CLASSIFY(more, "overlap");
  RC_ASSERT(overlaps(t, center, half) == more);
}

TEST(Triangle, TouchingIsOverlapping) {
  const Triangle t{glm::dvec3{1, -2, -2}, {1, 2, -2}, {1, 0, 3}};
  EXPECT_TRUE(overlaps(t, {0, 0, 0}, {1, 1, 1}));
  EXPECT_FALSE(overlaps(t, {0, 0, 0}, {0.999, 1, 1}));
  EXPECT_TRUE(overlaps(t, {1, 0, 0}, {0, 0, 0})) << "a box without size, on it";
}

// No point of the triangle is closer, by trying many.
RC_GTEST_PROP(Triangle, ClosestPointIsTheClosest, ()) {
  const Triangle t = any_triangle(1);
  const glm::dvec3 point = any_point(3);
  const glm::dvec3 w = closest_point(t, point);
  RC_ASSERT(std::min({w.x, w.y, w.z}) >= -1e-12);
  RC_ASSERT(std::abs(w.x + w.y + w.z - 1) < 1e-12);
  const double found = glm::distance(point_at(t, w), point);
  constexpr int kSteps = 40;
  double least = 1e9;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j + i <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
      least = std::min(least, glm::distance(point_at(t, {1 - u - v, u, v}), point));
    }
  }
  RC_ASSERT(found <= least + 1e-9);
  RC_ASSERT(found >= least - 4.0 / kSteps);  // no further from it than one step of the trial
}

}  // namespace
}  // namespace splatscope::traces
