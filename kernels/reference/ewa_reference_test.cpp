#include "kernels/reference/ewa_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "kernels/reference/random_surfels.h"

namespace splatscope::kernels {
namespace {

View facing_view(int size) {
  return look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, size, size, 0.1, 10.0);
}

Surfel facing_surfel() {
  Surfel surfel;
  surfel.tangent_s = {0.1, 0, 0};
  surfel.tangent_t = {0, 0.1, 0};
  surfel.color = {0.25, 0.5, 1.0};
  return surfel;
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

void compare_with_brute_force(const ReferenceSettings& settings, std::uint32_t seed) {
  std::printf("seed %u\n", seed);
  std::mt19937 generator(seed);
  const View view = look_at({0.2, 0.1, -3.0}, {0, 0, 0}, {0, 1, 0}, 70.0, 60, 48, 1.8, 4.0);
  const std::vector<Surfel> surfels = random_surfels(40, generator);
  const ReferencePicture picture = ewa_reference(view, surfels, settings);
  std::size_t pixel = 0;
  int lit = 0;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column, ++pixel) {
      glm::dvec4 sum(0.0);
      for (const Surfel& surfel : surfels) {
        const auto part = contribution(view, surfel, settings, column, row);
        if (part && part->distance <= 0) sum += part->weight * glm::dvec4(part->color, 1.0);
      }
      lit += sum.w > 0;
      for (int i = 0; i < 4; ++i) ASSERT_NEAR(picture.sums[pixel][i], sum[i], 1e-9 * (1 + sum[i]));
      ASSERT_EQ(picture.coverage[pixel], sum.w > 0 ? Coverage::certain : Coverage::none);
      const glm::dvec3 mean = sum.w > 0 ? glm::dvec3(sum) / sum.w : glm::dvec3(0.0);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(picture.normalized[pixel][i], mean[i], 1e-9);
      ASSERT_EQ(picture.lowest[pixel], picture.normalized[pixel]);
      ASSERT_EQ(picture.highest[pixel], picture.normalized[pixel]);
    }
  }
  EXPECT_GT(lit, 500);
}

TEST(EwaReference, brute_force_square) {
  compare_with_brute_force({true, 1.0, CutoffShape::square, 0.0}, 11);
}
TEST(EwaReference, brute_force_circle) {
  compare_with_brute_force({true, 1.5, CutoffShape::circle, 0.0}, 12);
}
TEST(EwaReference, brute_force_plain) {
  compare_with_brute_force({false, 2.0, CutoffShape::square, 0.0}, 13);
}

// At z = 2 h is 2.5 pixels: r^2 = 1 + 1/6.25, and pixel (51, 50) is a pixel, 0.4 h, from the surfel's.
TEST(EwaReference, one_facing_surfel) {
  const View view = facing_view(100);
  const std::vector<Surfel> surfels{facing_surfel()};
  const ReferencePicture picture = ewa_reference(view, surfels, {});
  const double expected = std::exp(-0.5 * 0.16 / 1.16) / (2.0 * std::numbers::pi * 1.16);
  const glm::dvec4& sum = picture.sums[50 * 100 + 51];
  EXPECT_NEAR(sum.w, expected, 1e-12);
  EXPECT_NEAR(sum.g, 0.5 * expected, 1e-12);
  EXPECT_NEAR(picture.normalized[50 * 100 + 51].b, 1.0, 1e-12);
  EXPECT_EQ(picture.coverage[0], Coverage::none);
}

// The screen-space filter has unit volume (Eq. 5 against Eq. 7: |J| times the weights).
TEST(EwaReference, weights_sum_to_one_over_the_jacobian) {
  const View view = facing_view(200);
  const std::vector<Surfel> surfels{facing_surfel()};
  ReferenceSettings settings;
  settings.cutoff = 20.0;
  double sum = 0;
  for (const glm::dvec4& pixel : ewa_reference(view, surfels, settings).sums) sum += pixel.w;
  EXPECT_NEAR(sum, 25.0,
              1e-6);  // 5 pixels for h: |J| = 25, J^-1 J^-T integrates over u, a pixel is 1/25 of u
}

TEST(EwaReference, near_plane_crossing_stays_finite) {
  const View view = facing_view(64);
  Surfel surfel = facing_surfel();
  surfel.tangent_s = {5.0, 0, 5.0};
  surfel.tangent_t = {0, 5.0, 0};
  const std::vector<Surfel> surfels{surfel};
  const ReferencePicture picture = ewa_reference(view, surfels, {});
  double largest = 0;
  for (const glm::dvec4& sum : picture.sums) {
    ASSERT_TRUE(std::isfinite(sum.w));
    largest = std::max(largest, sum.w);
  }
  EXPECT_GT(largest, 0.1);
}

// Bounds against every choice of the splats within the tolerance.
TEST(EwaReference, bounds_are_those_of_all_choices) {
  constexpr std::uint32_t kSeed = 17;
  std::printf("seed %u\n", kSeed);
  std::mt19937 generator(kSeed);
  const View view = look_at({0.2, 0.1, -3.0}, {0, 0, 0}, {0, 1, 0}, 70.0, 40, 32, 1.8, 4.0);
  const std::vector<Surfel> surfels = random_surfels(14, generator);
  const ReferenceSettings settings{true, 1.0, CutoffShape::square, 0.4};
  const ReferencePicture picture = ewa_reference(view, surfels, settings);
  int uncertain = 0;
  int bounded = 0;
  std::size_t pixel = 0;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column, ++pixel) {
      glm::dvec4 certain(0.0);
      std::vector<glm::dvec4> ties;
      for (const Surfel& surfel : surfels) {
        const auto part = contribution(view, surfel, settings, column, row);
        if (!part || part->distance >= settings.cutoff_tolerance) continue;
        const glm::dvec4 term = part->weight * glm::dvec4(part->color, 1.0);
        if (part->distance <= -settings.cutoff_tolerance) {
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
      ASSERT_EQ(picture.coverage[pixel], coverage);
      uncertain += coverage == Coverage::uncertain;
      bounded += !ties.empty();
      if (coverage == Coverage::none) low = high = glm::dvec3(0.0);
      for (int i = 0; i < 3; ++i) {
        ASSERT_NEAR(picture.lowest[pixel][i], low[i], 1e-9);
        ASSERT_NEAR(picture.highest[pixel][i], high[i], 1e-9);
      }
    }
  }
  EXPECT_GT(uncertain, 20);
  EXPECT_GT(bounded, 100);
}

TEST(EwaReference, surfels_without_a_filter_are_counted) {
  std::vector<Surfel> surfels{facing_surfel(), facing_surfel(), facing_surfel()};
  surfels[1].position.z = -3.0;
  const ReferencePicture picture = ewa_reference(facing_view(32), surfels, {});
  EXPECT_EQ(picture.skipped, 1u);
}

}  // namespace
}  // namespace splatscope::kernels
