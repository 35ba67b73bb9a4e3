#include "kernels/reference/surfel_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace splatscope::kernels {
namespace {

View test_view() {
  return look_at({0.3, -0.2, -4.0}, {0.1, 0.4, 1.0}, {0.1, 1.0, 0.05}, 60.0, 640, 512, 0.1, 100.0);
}

Surfel tilted_surfel() {
  Surfel surfel;
  surfel.position = {0.6, -0.5, 1.0};
  surfel.tangent_s = 0.02 * glm::normalize(glm::dvec3(1.0, 0.3, 2.0));
  surfel.tangent_t = 0.02 * glm::normalize(glm::cross(glm::dvec3(0.1, 1.0, 0.2), surfel.tangent_s));
  surfel.sigma = 0.7;
  return surfel;
}

void expect_near(const glm::dmat2& a, const glm::dmat2& b, double tolerance) {
  for (int column = 0; column < 2; ++column) {
    for (int row = 0; row < 2; ++row) EXPECT_NEAR(a[column][row], b[column][row], tolerance);
  }
}

TEST(View, TargetIsInTheMiddleAndUpIsUp) {
  const View view = test_view();
  const glm::dvec2 middle = view.window(view.camera_space({0.1, 0.4, 1.0}));
  EXPECT_NEAR(middle.x, 320.5, 1e-9);
  EXPECT_NEAR(middle.y, 256.5, 1e-9);
  EXPECT_LT(view.window(view.camera_space({0.1, 0.5, 1.0})).y, 256.0);
  EXPECT_GT(view.window(view.camera_space({0.2, 0.4, 1.0})).x, 320.0);
  EXPECT_NEAR(view.eta, 256.0 / std::tan(std::acos(-1.0) / 6.0), 1e-9);
}

TEST(SurfelFilter, JacobianIsTheDerivativeOfTheProjection) {
  const View view = test_view();
  const Surfel surfel = tilted_surfel();
  const glm::dmat2 jacobian = surfel_filter(view, surfel, true)->jacobian;
  const auto window = [&](double us, double ut) {
    return view.window(view.camera_space(surfel.position + us * surfel.tangent_s + ut * surfel.tangent_t));
  };
  const double step = 1e-4;
  expect_near(
      jacobian,
      {(window(step, 0) - window(-step, 0)) / (2 * step), (window(0, step) - window(0, -step)) / (2 * step)},
      1e-7);
}

// J M J^T = sigma^2 J J^T + I (Eq. 5), and Eq. 11.
TEST(SurfelFilter, ScreenSpaceFilterAndDecomposition) {
  const View view = test_view();
  const Surfel surfel = tilted_surfel();
  const SurfelFilter filter = *surfel_filter(view, surfel, true);
  const glm::dmat2 j = filter.jacobian;
  expect_near(j * filter.variance * glm::transpose(j), 0.49 * j * glm::transpose(j) + glm::dmat2(1.0), 1e-12);
  expect_near(filter.axes * glm::transpose(filter.axes), filter.variance, 1e-12);
  EXPECT_NEAR(filter.determinant, glm::determinant(filter.variance), 1e-12);
  EXPECT_NEAR(glm::dot(filter.axes[0], filter.axes[1]), 0.0, 1e-12);
  EXPECT_GT(glm::length(filter.axes[0]), glm::length(filter.axes[1]));
}

TEST(SurfelFilter, ReconstructionFilterAlone) {
  const SurfelFilter filter = *surfel_filter(test_view(), tilted_surfel(), false);
  expect_near(filter.axes, glm::dmat2(0.7), 1e-15);
  EXPECT_NEAR(filter.determinant, std::pow(0.7, 4), 1e-15);
}

// A plane that faces the camera: J is a multiple of I on the axis, t = 0, and the axes are those of s and t.
TEST(SurfelFilter, FacingPlane) {
  const View view = look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, 100, 100, 0.1, 10.0);
  Surfel surfel;
  surfel.tangent_s = {0.1, 0, 0};
  surfel.tangent_t = {0, 0.1, 0};
  surfel.sigma = 0.5;
  const SurfelFilter filter = *surfel_filter(view, surfel, true);
  // eta = 50, z = 2: 2.5 pixels for h, so r^2 = 0.25 + 1/6.25.
  expect_near(filter.axes, glm::dmat2(std::sqrt(0.41)), 1e-12);
}

// cos = 1e-6: from the entries of M the smaller eigenvalue would be lost.
TEST(SurfelFilter, EdgeOnKeepsTheSmallAxis) {
  const View view = look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, 100, 100, 0.1, 10.0);
  Surfel surfel;
  surfel.tangent_s = {0.1, 0, 0};
  surfel.tangent_t = {0, 0.1e-6, 0.1};
  surfel.sigma = 0.5;
  const SurfelFilter filter = *surfel_filter(view, surfel, true);
  EXPECT_NEAR(glm::length(filter.axes[1]), std::sqrt(0.41), 1e-6);
  EXPECT_NEAR(glm::length(filter.axes[0]) / 4e5, 1.0, 1e-6);
}

TEST(SurfelFilter, SurfelsWithoutAnAffineMapHaveNone) {
  const View view = look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, 100, 100, 0.1, 10.0);
  Surfel surfel;
  surfel.tangent_s = {0.1, 0, 0};
  surfel.tangent_t = {0, 0, 0.1};  // the eye is in the plane
  EXPECT_FALSE(surfel_filter(view, surfel, true));
  surfel.tangent_t = {0, 0.1, 0};
  EXPECT_TRUE(surfel_filter(view, surfel, true));
  surfel.position.z = -1.95;  // before the near plane
  EXPECT_FALSE(surfel_filter(view, surfel, true));
}

}  // namespace
}  // namespace splatscope::kernels
