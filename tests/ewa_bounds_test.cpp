#include "ewa_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "kernels/reference/random_surfels.h"

namespace splatscope::tests {
namespace {

using kernels::CutoffShape, kernels::ReferenceSettings, kernels::Surfel, kernels::View;

// What a machine samples at y, the texture clamped to its edge.
double sample(const Texture& texture, double cutoff, const glm::dvec2& y) {
  const auto index = [&](double coordinate) {
    const double v = 0.5 * (coordinate / std::sqrt(2.0 * cutoff) + 1.0);
    const double texel = std::floor(v * texture.width);
    return static_cast<std::size_t>(std::fmax(0.0, std::fmin(texel, texture.width - 1.0)));
  };
  return texture.texels[index(y.y) * texture.width + index(y.x)] / 255.0;
}

void expect_range(CutoffShape shape, const glm::dvec2& y, bool low, bool high) {
  const double value = std::exp(-0.5 * (y.x * y.x + y.y * y.y));
  const FilterRange range =
      filter_range({.shape = shape}, {.cutoff_tolerance = 0.01, .edge_tolerance = 0.05}, y);
  EXPECT_DOUBLE_EQ(range.low, low ? value : 0.0) << y.x << " " << y.y;
  EXPECT_DOUBLE_EQ(range.high, high ? value : 0.0) << y.x << " " << y.y;
}

TEST(EwaBounds, CutoffAndEdgeMayPassEitherSideWithinTheirTolerances) {
  constexpr CutoffShape kCircle = CutoffShape::circle, kSquare = CutoffShape::square;
  const double diagonal = std::sqrt(0.5);
  const auto at = [&](double radius) { return radius * glm::dvec2(diagonal, -diagonal); };
  const double r = std::sqrt(2.0);
  expect_range(kCircle, at(r - 0.011), true, true);
  expect_range(kCircle, at(r - 0.009), false, true);
  expect_range(kCircle, at(r + 0.009), false, true);
  expect_range(kCircle, at(r + 0.011), false, false);
  expect_range(kCircle, {r - 0.051, 0.0}, true, true);
  expect_range(kCircle, {r - 0.049, 0.0}, false, true);
  expect_range(kCircle, {0.0, -r - 0.049}, false, true);  // the last texel is inside the circle
  expect_range(kCircle, {0.0, -r - 0.051}, false, false);
  expect_range(kSquare, {r - 0.049, 1.0}, false, true);
  expect_range(kSquare, {r - 0.051, 1.0}, true, true);
}

// The range is that of the texels sampled at every y within the tolerance, and at nothing beyond the edge.
void compare_with_texture(CutoffShape shape, double tolerance, std::uint32_t seed) {
  std::printf("seed %u\n", seed);
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const ReferenceSettings filter{.shape = shape};
  const Leave leave{.cutoff_tolerance = tolerance, .edge_tolerance = 0.03, .texture_length = 23};
  const Texture texture = kernels::alpha_texture(filter.cutoff, leave.texture_length, shape);
  const double r = std::sqrt(2.0);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 y{1.5 * uniform(generator), 1.5 * uniform(generator)};
    const FilterRange range = filter_range(filter, leave, y);
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
        const double value = sample(texture, filter.cutoff, y + tolerance / kSteps * glm::dvec2(column, row));
        low = std::fmin(low, value);
        high = std::fmax(high, value);
      }
    }
    if (to_edge > -0.03) low = 0.0;
    EXPECT_EQ(range.low, low) << y.x << " " << y.y;
    EXPECT_EQ(range.high, high) << y.x << " " << y.y;
  }
}

TEST(EwaBounds, TexelOfASquareTexture) {
  compare_with_texture(CutoffShape::square, 0.0, 1);
}
TEST(EwaBounds, TexelOfACircularTexture) {
  compare_with_texture(CutoffShape::circle, 0.0, 2);
}
TEST(EwaBounds, TexelsWithinATolerance) {
  compare_with_texture(CutoffShape::circle, 0.2, 3);
}

struct Contribution {
  double distance = 0;  // y beyond the cutoff
  double weight = 0;
  glm::dvec3 color{};
};

// What a surfel gives one pixel, by solving o + us s + ut t = z d.
std::optional<Contribution> contribution(const View& view, const Surfel& surfel,
                                         const ReferenceSettings& settings, int column, int row) {
  const auto filter = surfel_filter(view, surfel, settings.prefilter);
  if (!filter) return std::nullopt;
  const glm::dvec3 d{(column + 0.5 - view.center().x) / view.eta, -(row + 0.5 - view.center().y) / view.eta,
                     1.0};
  const glm::dmat3 system{view.camera_direction(surfel.tangent_s), view.camera_direction(surfel.tangent_t),
                          -d};
  const glm::dvec3 solution = glm::inverse(system) * -view.camera_space(surfel.position);
  if (!(solution.z >= view.near_plane && solution.z <= view.far_plane)) return std::nullopt;
  const glm::dvec2 u(solution);
  const glm::dvec2 y = glm::inverse(filter->axes) * u;
  const double radius = std::sqrt(2.0 * settings.cutoff);
  Contribution result;
  result.distance = settings.shape == CutoffShape::circle ? glm::length(y) - radius
                                                          : std::max(std::abs(y.x), std::abs(y.y)) - radius;
  const double exponent = glm::dot(u, glm::inverse(filter->variance) * u);
  result.weight = surfel.weight / (2.0 * std::numbers::pi * std::sqrt(glm::determinant(filter->variance))) *
                  std::exp(-0.5 * exponent);
  result.color = surfel.color;
  return result;
}

// Bounds against every choice of the splats within the tolerance.
TEST(EwaBounds, BoundsAreThoseOfAllChoices) {
  constexpr std::uint32_t kSeed = 17;
  std::printf("seed %u\n", kSeed);
  std::mt19937 generator(kSeed);
  const View view = kernels::look_at({0.2, 0.1, -3.0}, {0, 0, 0}, {0, 1, 0}, 70.0, 40, 32, 1.8, 4.0);
  const std::vector<Surfel> surfels = kernels::random_surfels(14, generator);
  const ReferenceSettings filter;
  const Leave leave{.cutoff_tolerance = 0.4};
  const EwaBounds bounds = ewa_bounds(view, surfels, filter, leave);
  int uncertain = 0;
  int bounded = 0;
  std::size_t pixel = 0;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column, ++pixel) {
      glm::dvec4 certain(0.0);
      std::vector<glm::dvec4> ties;
      for (const Surfel& surfel : surfels) {
        const auto part = contribution(view, surfel, filter, column, row);
        if (!part || part->distance >= leave.cutoff_tolerance) continue;
        const glm::dvec4 term = part->weight * glm::dvec4(part->color, 1.0);
        if (part->distance <= -leave.cutoff_tolerance) {
          certain += term;
        } else {
          ties.push_back(term);
        }
      }
      glm::dvec3 low(INFINITY);
      glm::dvec3 high(-INFINITY);
      for (unsigned choice = 0; choice < 1u << ties.size(); ++choice) {
        glm::dvec4 sum = certain;
        for (std::size_t i = 0; i < ties.size(); ++i) sum += (choice >> i & 1u ? 1.0 : 0.0) * ties[i];
        if (!(sum.w > 0)) continue;
        low = glm::min(low, glm::dvec3(sum) / sum.w);
        high = glm::max(high, glm::dvec3(sum) / sum.w);
      }
      const Coverage coverage = certain.w > 0  ? Coverage::certain
                                : ties.empty() ? Coverage::none
                                               : Coverage::uncertain;
      ASSERT_EQ(bounds.coverage[pixel], coverage);
      uncertain += coverage == Coverage::uncertain;
      bounded += !ties.empty();
      if (coverage == Coverage::none) low = high = glm::dvec3(0.0);
      for (int i = 0; i < 3; ++i) {
        ASSERT_NEAR(bounds.lowest[pixel][i], low[i], 1e-9);
        ASSERT_NEAR(bounds.highest[pixel][i], high[i], 1e-9);
      }
    }
  }
  EXPECT_GT(uncertain, 20);
  EXPECT_GT(bounded, 100);
}

}  // namespace
}  // namespace splatscope::tests
