#include "kernels/reference/filter_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace splatscope::kernels {
namespace {

// What a machine samples at y, the texture clamped to its edge.
double sample(const Texture& texture, const ReferenceSettings& settings, const glm::dvec2& y) {
  const auto index = [&](double coordinate) {
    const double v = 0.5 * (coordinate / std::sqrt(2.0 * settings.cutoff) + 1.0);
    const double texel = std::floor(v * texture.width);
    return static_cast<std::size_t>(std::fmax(0.0, std::fmin(texel, texture.width - 1.0)));
  };
  return texture.texels[index(y.y) * texture.width + index(y.x)] / 255.0;
}

TEST(FilterValue, gaussian_within_its_cutoff) {
  ReferenceSettings settings;  // c = 1: sqrt 2
  EXPECT_DOUBLE_EQ(filter_value(settings, {1.4, -1.4}), std::exp(-1.96));
  EXPECT_EQ(filter_value(settings, {1.42, 0.0}), 0.0);
  settings.shape = CutoffShape::circle;
  EXPECT_EQ(filter_value(settings, {1.4, -1.4}), 0.0);
  EXPECT_DOUBLE_EQ(filter_value(settings, {0.0, -1.41}), std::exp(-0.5 * 1.41 * 1.41));
}

void expect_range(const ReferenceSettings& settings, const glm::dvec2& y, bool low, bool high) {
  const double value = std::exp(-0.5 * (y.x * y.x + y.y * y.y));
  const FilterRange range = filter_range(settings, y);
  EXPECT_DOUBLE_EQ(range.low, low ? value : 0.0) << y.x << " " << y.y;
  EXPECT_DOUBLE_EQ(range.high, high ? value : 0.0) << y.x << " " << y.y;
}

TEST(FilterValue, cutoff_and_edge_may_pass_either_side_within_their_tolerances) {
  ReferenceSettings settings;
  settings.shape = CutoffShape::circle;
  settings.cutoff_tolerance = 0.01;
  settings.edge_tolerance = 0.05;
  const double diagonal = std::sqrt(0.5);
  const auto at = [&](double radius) { return radius * glm::dvec2(diagonal, -diagonal); };
  const double r = std::sqrt(2.0);
  expect_range(settings, at(r - 0.011), true, true);
  expect_range(settings, at(r - 0.009), false, true);
  expect_range(settings, at(r + 0.009), false, true);
  expect_range(settings, at(r + 0.011), false, false);
  expect_range(settings, {r - 0.051, 0.0}, true, true);
  expect_range(settings, {r - 0.049, 0.0}, false, true);
  expect_range(settings, {0.0, -r - 0.049}, false, true);  // the last texel is inside the circle
  expect_range(settings, {0.0, -r - 0.051}, false, false);
  settings.shape = CutoffShape::square;
  expect_range(settings, {r - 0.049, 1.0}, false, true);
  expect_range(settings, {r - 0.051, 1.0}, true, true);
  EXPECT_DOUBLE_EQ(filter_reach(settings), r + 0.05);
}

// The range is that of the texels sampled at every y within the tolerance, and at nothing beyond the edge.
void compare_with_texture(CutoffShape shape, double tolerance, std::uint32_t seed) {
  std::printf("seed %u\n", seed);
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ReferenceSettings settings;
  settings.shape = shape;
  settings.texture_length = 23;
  settings.cutoff_tolerance = tolerance;
  settings.edge_tolerance = 0.03;
  const Texture texture = alpha_texture(1.0, 23, shape);
  const double r = std::sqrt(2.0);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 y{1.5 * uniform(generator), 1.5 * uniform(generator)};
    const FilterRange range = filter_range(settings, y);
    const double to_edge = std::fmax(std::abs(y.x), std::abs(y.y)) - r;
    if (to_edge > 0.03) {
      EXPECT_EQ(range.high, 0.0);
      continue;
    }
    double low = 1.0;
    double high = 0.0;
    constexpr int kSteps = 40;
    for (int column = -kSteps; column <= kSteps; ++column) {
      for (int row = -kSteps; row <= kSteps; ++row) {
        const double value = sample(texture, settings, y + tolerance / kSteps * glm::dvec2(column, row));
        low = std::fmin(low, value);
        high = std::fmax(high, value);
      }
    }
    if (to_edge > -0.03) low = 0.0;
    EXPECT_EQ(range.low, low) << y.x << " " << y.y;
    EXPECT_EQ(range.high, high) << y.x << " " << y.y;
  }
}

TEST(FilterValue, texel_of_a_square_texture) {
  compare_with_texture(CutoffShape::square, 0.0, 1);
}
TEST(FilterValue, texel_of_a_circular_texture) {
  compare_with_texture(CutoffShape::circle, 0.0, 2);
}
TEST(FilterValue, texels_within_a_tolerance) {
  compare_with_texture(CutoffShape::circle, 0.2, 3);
}

}  // namespace
}  // namespace splatscope::kernels
