#include "kernels/reference/layered_splatting.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/reference/screen_space.h"
#include "kernels/reference/sphere.h"

namespace splatscope::kernels {
namespace {

const View kView = look_at({0, 0, -10}, {0, 0, 0}, {0, 1, 0}, 30.0, 64, 64, 1.0, 100.0);
constexpr std::size_t kMiddle = 32 * 64 + 32;

// One large surfel that faces the eye.
Surfel disc(double z, const glm::dvec3& color) {
  Surfel surfel;
  surfel.position.z = z;
  surfel.tangent_s = {1, 0, 0};
  surfel.tangent_t = {0, -1, 0};
  surfel.color = color;
  return surfel;
}

constexpr glm::dvec3 kRed{1, 0, 0}, kGreen{0, 1, 0}, kBlue{0, 0, 1};

glm::dvec4 middle(std::span<const Surfel> surfels, std::span<const double> opacities,
                  const LayeredSettings& settings) {
  return layered_splatting(kView, surfels, opacities, settings).pixels[kMiddle];
}

void expect_color(const glm::dvec4& pixel, const glm::dvec4& expected) {
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(pixel[c], expected[c], 1e-12) << c;
}

TEST(LayeredSplatting, TheThresholdsThreeOutcomes) {
  const LayeredSettings settings{.same_surface = 0.5};
  const Surfel near = disc(0, kRed), same = disc(0.4, kGreen), far = disc(2, kBlue);
  // Replaced by what is nearer, in either order; what is further is dropped.
  expect_color(middle(std::array{far, near}, {}, settings), {kRed, 1});
  expect_color(middle(std::array{near, far}, {}, settings), {kRed, 1});
  // Within the threshold: the mean by weight, which is nearly even and in favour of the nearer and larger
  // one.
  const glm::dvec4 sum = middle(std::array{near, same}, {}, settings);
  EXPECT_NEAR(sum.r + sum.g, 1, 1e-12);
  EXPECT_NEAR(sum.g, 0.5, 0.05);

  const LayeredPicture picture = layered_splatting(kView, std::array{far, near, same, far}, {}, settings);
  EXPECT_GT(picture.outcomes.added, 100u);
  EXPECT_GT(picture.outcomes.replaced, 100u);
  EXPECT_GT(picture.outcomes.dropped, 100u);
}

TEST(LayeredSplatting, LayersBlendFrontToBackInAnyOrder) {
  LayeredSettings settings{.same_surface = 0.5, .layers = 3, .background = {0.2, 0.2, 0.2}};
  const std::array discs{disc(0, kRed), disc(2, kGreen), disc(4, kBlue)};
  const std::array opacities{0.5, 0.25, 0.8};
  const glm::dvec4 expected{glm::dvec3(0.5, 0.125, 0.3) + 0.075 * settings.background, 0.925};
  std::array order{0u, 1u, 2u};
  do {
    std::vector<Surfel> surfels;
    std::vector<double> opacity;
    for (const unsigned i : order) {
      surfels.push_back(discs[i]);
      opacity.push_back(opacities[i]);
    }
    expect_color(middle(surfels, opacity, settings), expected);
  } while (std::next_permutation(order.begin(), order.end()));
  settings.layers = 2;  // the furthest goes, wherever it comes
  const glm::dvec4 nearest_two{glm::dvec3(0.5, 0.125, 0) + 0.375 * settings.background, 0.625};
  expect_color(middle(discs, opacities, settings), nearest_two);
  expect_color(middle(std::array{discs[2], discs[0], discs[1]}, std::array{0.8, 0.5, 0.25}, settings),
               nearest_two);
}

// A sheet of surfels that ends at x = 0 covers its pixels as the integral of the filter says.
TEST(LayeredSplatting, CoverageOfAnEdgeIsThatOfTheFilter) {
  constexpr double kSpacing = 0.05;
  std::vector<Surfel> surfels;
  for (int row = -60; row <= 60; ++row) {
    for (int column = 0; column < 60; ++column) {
      Surfel surfel = disc(0, {1, 1, 1});
      surfel.position = {kSpacing * (column + 0.5), kSpacing * row, 0};
      surfel.tangent_s *= kSpacing;
      surfel.tangent_t *= kSpacing;
      surfels.push_back(surfel);
    }
  }
  LayeredSettings settings{.cutoff = 12, .same_surface = 0.5};
  const LayeredPicture whole = layered_splatting(kView, surfels, {}, settings);
  settings.whole_weight = whole.weights[32 * 64 + 46];
  const LayeredPicture picture = layered_splatting(kView, surfels, {}, settings);
  const double pixels = kView.eta / 10;  // of an object unit
  const double deviation = std::sqrt(1 + std::pow(kSpacing * pixels, 2));
  // The surfels are the midpoint rule of that integral: h^2/24 times the Gaussian's slope, at most
  // exp(-1/2)/sqrt(2 pi) over the variance.
  const double tolerance = 1.05 * std::pow(kSpacing * pixels / deviation, 2) / 24 * 0.24197;
  for (int column = 26; column < 40; ++column) {
    const double from_edge = (column + 0.5 - kView.center().x) / deviation;
    const double coverage = 0.5 * std::erfc(-from_edge / std::sqrt(2.0));
    EXPECT_NEAR(picture.pixels[static_cast<std::size_t>(32 * 64 + column)].w, coverage, tolerance) << column;
  }
}

// On a closed surface with its back culled, one layer gives the colours of the two-pass renderer wherever
// that one has no other surface near.
TEST(LayeredSplatting, SphereIsThatOfTheTwoPassRenderer) {
  constexpr int kPoints = 9001;
  const std::vector<Surfel> surfels = sphere(kPoints);
  const View view = sphere_view(160);
  const LayeredPicture picture = layered_splatting(
      view, surfels, {},
      {.cutoff = 1, .same_surface = 100 * sphere_spacing(kPoints), .cull_back_faces = true});
  const ScreenSpacePicture reference =
      screen_space_ewa(view, surfels,
                       {.filter = {.cutoff = 1, .shape = CutoffShape::circle},
                        .depth_offset = 100 * sphere_spacing(kPoints),
                        .cull_back_faces = true});
  std::size_t compared = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    // A layer's z is finite where a quad's plane is not before the near plane; sums agree there to rounding.
    if (std::abs(picture.weights[i] - reference.sums[i].w) > 1e-9) continue;
    if (!(picture.weights[i] > 0)) continue;
    ++compared;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(picture.pixels[i][c], reference.normalized[i][c], 1e-9) << i;
  }
  const auto covered = std::ranges::count_if(reference.sums, [](const glm::dvec4& sum) { return sum.w > 0; });
  EXPECT_GT(compared, static_cast<std::size_t>(0.95 * static_cast<double>(covered)));
}

TEST(LayeredSplatting, SameBitsForAnyNumberOfThreads) {
  constexpr int kPoints = 9001;
  const std::vector<Surfel> surfels = sphere(kPoints);
  const std::vector<double> opacities(surfels.size(), 0.6);
  const LayeredSettings settings{.same_surface = 2 * sphere_spacing(kPoints), .layers = 4};
  const LayeredPicture picture = layered_splatting(sphere_view(128), surfels, opacities, settings);
  for (const std::size_t threads : {1, 3}) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    const LayeredPicture again = layered_splatting(sphere_view(128), surfels, opacities, settings);
    EXPECT_EQ(again.pixels, picture.pixels) << threads;
    EXPECT_EQ(again.outcomes, picture.outcomes) << threads;
  }
  // Front and back of the sphere show through one another: 1 - 0.4^2.
  EXPECT_NEAR(picture.pixels[64 * 128 + 64].w, 0.84, 1e-9);
}

}  // namespace
}  // namespace splatscope::kernels
