#include "kernels/reference/screen_space.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "kernels/reference/random_surfels.h"

namespace splatscope::kernels {
namespace {

View test_view() {
  return look_at({0.2, 0.1, -3.0}, {0, 0, 0}, {0, 1, 0}, 70.0, 60, 48, 1.8, 4.0);
}

ScreenSpaceSettings settings_of(ScreenMap map, double cutoff = 1.0) {
  return {.filter = {.prefilter = true, .cutoff = cutoff, .shape = CutoffShape::circle}, .map = map};
}

Surfel tilted_surfel() {
  Surfel surfel;
  surfel.position = {0.2, -0.1, 0.1};
  surfel.tangent_s = {0.2, 0.05, 0.1};
  surfel.tangent_t = 0.23 * glm::normalize(glm::cross(glm::dvec3(0.3, 0.2, 1), surfel.tangent_s));
  surfel.sigma = 0.8;
  surfel.weight = 1.25;
  surfel.color = {0.25, 0.5, 1.0};
  return surfel;
}

double gaussian(const glm::dmat2& variance, const glm::dvec2& x) {
  return std::exp(-0.5 * glm::dot(x, glm::inverse(variance) * x)) /
         (2 * std::numbers::pi * std::sqrt(glm::determinant(variance)));
}

// Eq. 3 as it stands: the basis function, warped by m_k, convolved with the low-pass filter by a sum over a
// fine grid (exact to rounding for smooth functions that end inside it).
double convolved(const Surfel& surfel, const SurfelFilter& filter, const glm::dvec2& offset) {
  constexpr double kStep = 0.2, kReach = 8.0;  // pixels: standard deviations of h
  const glm::dmat2 to_plane = glm::inverse(filter.jacobian);
  double sum = 0;
  for (double dy = -kReach; dy <= kReach; dy += kStep) {
    for (double dx = -kReach; dx <= kReach; dx += kStep) {
      sum += gaussian(glm::dmat2(surfel.sigma * surfel.sigma), to_plane * (offset - glm::dvec2(dx, dy))) *
             gaussian(glm::dmat2(1.0), {dx, dy});
    }
  }
  return surfel.weight * sum * kStep * kStep;
}

TEST(ScreenSpace, OneSplatIsTheConvolutionOfEq3) {
  View view = test_view();
  view.near_plane = 0.1;  // the surfel's plane is within range under every pixel asked for
  view.far_plane = 100;
  const Surfel surfel = tilted_surfel();
  const SurfelFilter filter = *surfel_filter(view, surfel, true);
  ScreenSpaceSettings settings = settings_of(ScreenMap::affine, 40.0);
  settings.depth_offset = 10;
  const ScreenSpacePicture picture = screen_space_ewa(view, {&surfel, 1}, settings);
  const glm::dvec2 center = view.window(view.camera_space(surfel.position));
  for (int row = 10; row < 40; row += 4) {
    for (int column = 15; column < 50; column += 5) {
      const double expected = convolved(surfel, filter, glm::dvec2(column + 0.5, row + 0.5) - center);
      const glm::dvec4 sum = picture.sums[static_cast<std::size_t>(row * view.width + column)];
      EXPECT_NEAR(sum.w, expected, 1e-9) << column << ' ' << row;
      EXPECT_NEAR(sum.g, 0.5 * expected, 1e-9);
    }
  }
}

struct Hit {
  glm::dvec2 u{};
  double z = 0;
};

// o + u0 s + u1 t = z ray, solved as it stands.
Hit hit(const View& view, const Surfel& surfel, const glm::dvec2& x) {
  const glm::dvec3 ray((x.x - view.center().x) / view.eta, -(x.y - view.center().y) / view.eta, 1.0);
  const glm::dmat3 system{view.camera_direction(surfel.tangent_s), view.camera_direction(surfel.tangent_t),
                          -ray};
  const glm::dvec3 solution = glm::inverse(system) * -view.camera_space(surfel.position);
  return {{solution.x, solution.y}, solution.z};
}

// Every surfel at every pixel, by Eq. 5 (affine) or Eq. 7 and 8 (perspective) and section 5.1.
glm::dvec4 brute_force(const View& view, const std::vector<Surfel>& surfels,
                       const ScreenSpaceSettings& settings, const glm::dvec2& x) {
  const auto in_range = [&](double z) { return z >= view.near_plane && z <= view.far_plane; };
  const double shift = settings.depth_offset / glm::length(glm::dvec3((x - view.center()) / view.eta, 1.0));
  double depth = INFINITY;
  for (const Surfel& surfel : surfels) {
    const Hit at = hit(view, surfel, x);
    if (!surfel_filter(view, surfel, settings.filter.prefilter) || !in_range(at.z) || !in_range(at.z + shift))
      continue;
    if (std::max(std::abs(at.u.x), std::abs(at.u.y)) <= 1) depth = std::min(depth, at.z + shift);
  }
  glm::dvec4 sum(0.0);
  for (const Surfel& surfel : surfels) {
    const auto filter = surfel_filter(view, surfel, settings.filter.prefilter);
    const Hit at = hit(view, surfel, x);
    if (!filter || !in_range(at.z) || at.z > depth) continue;
    const glm::dmat2& j = filter->jacobian;
    const bool affine = settings.map == ScreenMap::affine;
    const glm::dvec2 from_center = affine ? x - view.window(view.camera_space(surfel.position)) : at.u;
    const glm::dmat2 variance =
        affine ? surfel.sigma * surfel.sigma * j * glm::transpose(j) + glm::dmat2(1.0) : filter->variance;
    const glm::dvec2 y = glm::inverse(affine ? j * filter->axes : filter->axes) * from_center;
    const double squared = settings.filter.shape == CutoffShape::square
                               ? std::max(y.x * y.x, y.y * y.y)
                               : glm::dot(from_center, glm::inverse(variance) * from_center);
    if (squared > 2 * settings.filter.cutoff) continue;
    const double scale = affine ? std::abs(glm::determinant(j)) : 1.0;  // 1/|J^-1|
    sum += surfel.weight * scale * gaussian(variance, from_center) * glm::dvec4(surfel.color, 1.0);
  }
  return sum;
}

void compare_with_brute_force(ScreenMap map, const ReferenceSettings& filter, std::uint32_t seed) {
  std::printf("seed %u\n", seed);
  std::mt19937 generator(seed);
  const View view = test_view();
  const std::vector<Surfel> surfels = random_surfels(200, generator);
  // Hidden surfels count where z_t is infinite.
  const ScreenSpaceSettings some{.filter = filter, .map = map, .depth_offset = 0.2},
      all{.filter = filter, .map = map, .depth_offset = INFINITY};
  const ScreenSpacePicture picture = screen_space_ewa(view, surfels, some),
                           unoccluded = screen_space_ewa(view, surfels, all);
  int lit = 0, occluded = 0;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      const auto pixel = static_cast<std::size_t>(row * view.width + column);
      const glm::dvec2 x(column + 0.5, row + 0.5);
      const glm::dvec4 expected = brute_force(view, surfels, some, x),
                       expected_of_all = brute_force(view, surfels, all, x);
      for (int i = 0; i < 4; ++i) {
        ASSERT_NEAR(picture.sums[pixel][i], expected[i], 1e-9 * (1 + expected[i])) << column << ' ' << row;
        ASSERT_NEAR(unoccluded.sums[pixel][i], expected_of_all[i], 1e-9 * (1 + expected_of_all[i]));
      }
      lit += expected.w > 0;
      occluded += picture.sums[pixel].w < unoccluded.sums[pixel].w;
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(occluded, 300);
}

TEST(ScreenSpace, BruteForceAffine) {
  compare_with_brute_force(ScreenMap::affine, {.cutoff = 1.5, .shape = CutoffShape::circle}, 21);
}
TEST(ScreenSpace, BruteForcePerspective) {
  compare_with_brute_force(ScreenMap::perspective, {.cutoff = 1.5, .shape = CutoffShape::circle}, 22);
}
TEST(ScreenSpace, BruteForceSquare) {
  compare_with_brute_force(ScreenMap::perspective, {.cutoff = 1, .shape = CutoffShape::square}, 11);
}
TEST(ScreenSpace, BruteForcePlain) {
  compare_with_brute_force(ScreenMap::perspective,
                           {.prefilter = false, .cutoff = 2, .shape = CutoffShape::square}, 13);
}

// A grid of surfels on the plane y = slope x, in the plane's own spacing.
std::vector<Surfel> plane(double slope, const glm::dvec3& color) {
  const glm::dvec3 along = glm::normalize(glm::dvec3(1, slope, 0));
  std::vector<Surfel> surfels;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      Surfel surfel;
      surfel.position = 0.1 * i * along + glm::dvec3(0, 0, 0.1 * j);
      surfel.tangent_s = 0.15 * along;
      surfel.tangent_t = {0, 0, 0.15};
      surfel.color = color;
      surfels.push_back(surfel);
    }
  }
  return surfels;
}

View view_from_above() {
  return look_at({0, 5, 0}, {0, 0, 0}, {0, 0, 1}, 40.0, 96, 64, 1.0, 20.0);
}

TEST(ScreenSpace, NothingOfAPlaneIsHidden) {
  const std::vector<Surfel> surfels = plane(0.4, {0.2, 0.4, 0.9});
  ScreenSpaceSettings settings = settings_of(ScreenMap::perspective);
  settings.depth_offset = 0.1;
  const ScreenSpacePicture picture = screen_space_ewa(view_from_above(), surfels, settings);
  settings.depth_offset = INFINITY;
  EXPECT_EQ(picture.sums, screen_space_ewa(view_from_above(), surfels, settings).sums);
}

// Right of the middle the rising plane is nearer, left of it the falling one; each hides the other where they
// are further apart along the ray than z_t.
TEST(ScreenSpace, CrossingSurfacesHideEachOther) {
  std::vector<Surfel> surfels = plane(0.5, {1, 0, 0});
  const std::vector<Surfel> falling = plane(-0.5, {0, 1, 0});
  surfels.insert(surfels.end(), falling.begin(), falling.end());
  const View view = view_from_above();
  for (ScreenMap map : {ScreenMap::affine, ScreenMap::perspective}) {
    ScreenSpaceSettings settings = settings_of(map);
    settings.depth_offset = 0.1;
    const ScreenSpacePicture picture = screen_space_ewa(view, surfels, settings);
    for (int column = 0; column < view.width; ++column) {
      const glm::dvec3 color = picture.normalized[static_cast<std::size_t>(32 * view.width + column)];
      const double x = 5 * (column + 0.5 - view.center().x) / view.eta;  // where the ray meets y = 0
      if (std::abs(x) < 0.02) {
        EXPECT_GT(std::min(color.r, color.g), 0.2);  // both, within z_t
      } else if (std::abs(x) > 0.15 && std::abs(x) < 1.2) {
        EXPECT_NEAR(x > 0 ? color.r : color.g, 1.0, 1e-12) << column;
      }
    }
  }
}

// The planes of large surfels reach past the eye.
TEST(ScreenSpace, NearPlaneCrossingStaysFinite) {
  Surfel surfel = tilted_surfel();
  surfel.position = {0, 0, 0};
  surfel.tangent_s = {5, 0, 5};
  surfel.tangent_t = {0, 5, 0};
  const View view = look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, 64, 64, 0.1, 10.0);
  ScreenSpaceSettings settings = settings_of(ScreenMap::perspective);
  settings.depth_offset = INFINITY;
  double largest = 0;
  for (const glm::dvec4& sum : screen_space_ewa(view, {&surfel, 1}, settings).sums) {
    ASSERT_TRUE(std::isfinite(sum.w));
    largest = std::max(largest, sum.w);
  }
  EXPECT_GT(largest, 0.1);
}

TEST(ScreenSpace, SameBitsForAnyNumberOfThreads) {
  std::mt19937 generator(23);
  const std::vector<Surfel> surfels = random_surfels(9000, generator);  // more than two chunks
  ScreenSpaceSettings settings = settings_of(ScreenMap::affine);
  settings.depth_offset = 0.05;
  const auto drawn = [&](std::size_t threads) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return screen_space_ewa(test_view(), surfels, settings);
  };
  const ScreenSpacePicture one = drawn(1), four = drawn(4);
  EXPECT_EQ(one.sums, four.sums);
  EXPECT_EQ(one.depth, four.depth);
  EXPECT_EQ(one.normalized, four.normalized);
}

TEST(ScreenSpace, BackFacesAreLeftOutOnDemand) {
  std::vector<Surfel> surfels{tilted_surfel(), tilted_surfel()};
  std::swap(surfels[1].tangent_s, surfels[1].tangent_t);  // the normal s x t turned about
  surfels[1].color = {1, 0, 0};
  ScreenSpaceSettings settings = settings_of(ScreenMap::affine);
  settings.depth_offset = 0.1;
  EXPECT_EQ(screen_space_ewa(test_view(), surfels, settings).culled, 0u);
  settings.cull_back_faces = true;
  const ScreenSpacePicture culled = screen_space_ewa(test_view(), surfels, settings);
  EXPECT_EQ(culled.culled, 1u);
  const View view = test_view();
  const glm::dvec3 o = view.camera_space(surfels[0].position);
  const glm::dvec3 normal =
      glm::cross(view.camera_direction(surfels[0].tangent_s), view.camera_direction(surfels[0].tangent_t));
  EXPECT_EQ(culled.sums,
            screen_space_ewa(view, {&surfels[glm::dot(normal, o) > 0 ? 1 : 0], 1}, settings).sums);
}

TEST(ScreenSpace, SurfelsThatCannotBeDrawnLeaveNoTrace) {
  const View view = look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, 100, 100, 0.1, 10.0);
  std::vector<Surfel> surfels(5);
  for (Surfel& surfel : surfels) {
    surfel.tangent_s = {0.1, 0, 0};
    surfel.tangent_t = {0, 0.1, 0};
  }
  surfels[1].tangent_t = {0, 0, 0.1};     // edge-on: the eye is in its plane
  surfels[2].tangent_t = {0, 1e-9, 0.1};  // nearly
  surfels[3].position = {0, 0, -5};       // behind the eye
  surfels[4].tangent_s = surfels[4].tangent_t = {0, 0, 0};
  for (ScreenMap map : {ScreenMap::affine, ScreenMap::perspective}) {
    ScreenSpaceSettings settings = settings_of(map);
    settings.depth_offset = 0.1;
    const ScreenSpacePicture picture = screen_space_ewa(view, surfels, settings);
    EXPECT_EQ(picture.skipped, 3u);
    for (const glm::dvec4& sum : picture.sums) {
      for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(sum[i]));
    }
    EXPECT_GT(picture.sums[50 * 100 + 50].w, 0.1);
    EXPECT_NEAR(picture.depth[50 * 100 + 50], 2.0, 1e-12);
  }
}

}  // namespace
}  // namespace splatscope::kernels
