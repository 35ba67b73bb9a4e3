#include "kernels/reference/fast_splatting.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstdio>

#include "kernels/reference/random_surfels.h"
#include "kernels/reference/screen_space.h"
#include "kernels/reference/sphere.h"

namespace splatscope::kernels {
namespace {

// dB of r g b, over the pixels where either picture has anything.
double psnr(const FastPicture& picture, const ScreenSpacePicture& reference) {
  double squares = 0, samples = 0;
  for (std::size_t pixel = 0; pixel < picture.pixels.size(); ++pixel) {
    if (!(picture.pixels[pixel].w > 0) && !(reference.sums[pixel].w > 0)) continue;
    samples += 3;
    const glm::dvec3 difference = glm::dvec3(picture.pixels[pixel]) - reference.normalized[pixel];
    squares += glm::dot(difference, difference);
  }
  EXPECT_GT(samples, 3000);
  return -10 * std::log10(squares / samples);
}

ScreenSpacePicture reference_of(const View& view, std::span<const Surfel> surfels,
                                const FastSettings& settings) {
  return screen_space_ewa(
      view, surfels,
      {.filter = {.prefilter = settings.prefilter, .cutoff = settings.cutoff, .shape = CutoffShape::circle},
       .map = ScreenMap::affine,
       .depth_offset = settings.depth_offset,
       .cull_back_faces = settings.cull_back_faces});
}

void compare(const View& view, std::span<const Surfel> surfels, const FastSettings& settings) {
  const FastPicture picture = FastSplatting(surfels).draw(view, settings);
  const ScreenSpacePicture reference = reference_of(view, surfels, settings);
  EXPECT_GT(psnr(picture, reference), 60);  // the table alone: 1e-3 c
  double weight = 0, expected = 0;
  for (std::size_t pixel = 0; pixel < picture.pixels.size(); ++pixel) {
    weight += picture.pixels[pixel].w;
    expected += reference.sums[pixel].w;
  }
  EXPECT_NEAR(weight / expected, 1, 1e-4);
}

TEST(FastSplatting, SphereIsThatOfTheDoublePrecisionRenderer) {
  const std::vector<Surfel> surfels = sphere(9001);  // no whole number of registers
  FastSettings settings{.depth_offset = sphere_spacing(9001)};
  compare(sphere_view(160), surfels, settings);
  settings.cull_back_faces = true;
  settings.cutoff = 2.5;
  compare(sphere_view(150), surfels, settings);
  settings.prefilter = false;
  compare(sphere_view(157), surfels, settings);
}

// Surfels in every direction, through the near plane, before it and beyond the far plane.
TEST(FastSplatting, SurfelsEverywhere) {
  constexpr std::uint32_t kSeed = 31;
  std::printf("seed %u\n", kSeed);
  std::mt19937 generator(kSeed);
  const std::vector<Surfel> surfels = random_surfels(300, generator);
  const View view = look_at({0.2, 0.1, -3.0}, {0, 0, 0}, {0, 1, 0}, 70.0, 90, 70, 1.8, 4.0);
  compare(view, surfels, {.depth_offset = 0.2});
  const FastPicture picture = FastSplatting(surfels).draw(view, {.depth_offset = 0.2});
  EXPECT_GE(picture.left_out, reference_of(view, surfels, {.depth_offset = 0.2}).skipped);
  EXPECT_LT(picture.left_out, 150u);
}

TEST(FastSplatting, SurfelsThatCannotBeDrawnLeaveNoTrace) {
  std::vector<Surfel> surfels(7);
  for (Surfel& surfel : surfels) {
    surfel.tangent_s = {0.1, 0, 0};
    surfel.tangent_t = {0, 0.1, 0};
    surfel.color = {1, 1, 1};
  }
  surfels[1].tangent_t = {0, 0, 0.1};      // edge-on: the eye is in its plane
  surfels[2].tangent_t = {0, 1e-20, 0.1};  // nearly
  surfels[3].position = {0, 0, -5};        // behind the eye
  surfels[4].tangent_s = surfels[4].tangent_t = {0, 0, 0};
  surfels[5].position = {1e30, 0, 1e30};  // more than floats hold
  surfels[5].tangent_s = {1e25, 0, 0};
  surfels[6].position.x = NAN;
  const View view = look_at({0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 90.0, 100, 100, 0.1, 10.0);
  const FastPicture picture = FastSplatting(surfels).draw(view, {.depth_offset = 0.1});
  for (const glm::vec4& pixel : picture.pixels) {
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(pixel[i]));
  }
  EXPECT_GT(picture.pixels[50 * 100 + 50].w, 0.1f);
  EXPECT_GE(picture.left_out, 5u);
}

TEST(FastSplatting, SameBitsForAnyNumberOfThreadsAndEverySimdTarget) {
  const std::vector<Surfel> surfels = sphere(9001);
  const View view = sphere_view(160);
  FastSplatting splatting(surfels);
  const FastSettings settings{.depth_offset = sphere_spacing(9001)};
  const FastPicture picture = splatting.draw(view, settings);
  for (std::size_t threads : {1, 3}) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(splatting.draw(view, settings).pixels, picture.pixels) << threads;
  }
  int targets = 0;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1, ++targets) {
    hwy::SetSupportedTargetsForTest(left & -left);
    EXPECT_EQ(splatting.draw(view, settings).pixels, picture.pixels) << hwy::TargetName(left & -left);
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GT(targets, 1);
}

}  // namespace
}  // namespace splatscope::kernels
