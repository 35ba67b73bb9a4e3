#include "studies/reference_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "model/error.h"
#include "traces/volumes/volume_scene.h"

namespace splatscope::studies {
namespace {

// 6 x 6 pixels, of which the inner 5 x 5 from (1, 1) on are a grey surface of weight 0.8 and depth 2; weight
// 0.1, under half of that, along the left edge.
kernels::ScreenSpacePicture grey_square() {
  kernels::ScreenSpacePicture picture;
  picture.width = picture.height = 6;
  picture.sums.resize(36);
  picture.normalized.resize(36);
  picture.depth.resize(36, std::numeric_limits<double>::infinity());
  for (std::size_t y = 1; y < 6; ++y) {
    for (std::size_t x = 0; x < 6; ++x) {
      const double weight = x == 0 ? 0.1 : 0.8;
      picture.sums[6 * y + x] = {0.5 * weight, 0.5 * weight, 0.5 * weight, weight};
      picture.normalized[6 * y + x] = glm::dvec3(0.5);
      if (x > 0) picture.depth[6 * y + x] = 2;
    }
  }
  return picture;
}

Frame grey_frame() {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  Frame frame(6, 6, formats);
  for (Vec4& color : frame.colors32) color = {0.5f, 0.5f, 0.5f, 1};
  return frame;
}

TEST(ReferenceComparison, AnExactFrameIsInfinitelyNear) {
  const Comparison c = compare(grey_frame(), grey_square());
  EXPECT_EQ(c.surface_pixels, 25u);
  EXPECT_EQ(c.inside_pixels, 9u);  // of the 5 x 5, those whose neighbours meet a quad and lie in the picture
  EXPECT_EQ(c.holes, 0u);
  EXPECT_EQ(c.psnr, INFINITY);
  EXPECT_EQ(c.worst, 0.0);
}

TEST(ReferenceComparison, CountsHolesAndDifferencesOnTheSurfaceAlone) {
  Frame frame = grey_frame();
  frame.colors32[6 * 3 + 3] = {0, 0, 0, 0};     // a hole
  frame.colors32[6 * 2 + 2] = {0, 0, 0, 0.5f};  // black, but something was drawn
  frame.colors32[6 * 5 + 5] = {0, 0, 0, 0};     // on the silhouette
  frame.colors32[6 * 3 + 0] = {1, 1, 1, 1};     // beyond the surface
  frame.colors32[6 * 4 + 3][1] += 7.0f / 255;
  frame.colors32[6 * 4 + 4][1] += 9.0f / 255;
  const Comparison c = compare(frame, grey_square());
  EXPECT_EQ(c.holes, 1u);
  EXPECT_EQ(c.rounded_to_black, 1u);
  EXPECT_EQ(c.over_8, 4u);
  EXPECT_NEAR(c.worst, 127.5, 1e-9);
  EXPECT_NEAR(c.psnr, -10 * std::log10((9 * 0.25 + (49 + 81) / (255.0 * 255)) / (3 * 25)), 1e-6);
}

TEST(ReferenceComparison, TellsWhatRoundedToBlackFromHoles) {
  Frame frame = grey_frame(), unrounded = grey_frame();
  for (const std::size_t pixel : {6 * 2 + 2, 6 * 2 + 3, 6 * 3 + 3}) frame.colors32[pixel] = {};
  unrounded.colors32[6 * 3 + 3] = {};
  const Comparison c = compare(frame, grey_square(), [&] { return unrounded; });
  EXPECT_EQ(c.holes, 1u);
  EXPECT_EQ(c.rounded_to_black, 2u);
  EXPECT_EQ(compare(frame, grey_square()).holes, 3u);
}

// 24 x 24 pixels of grey; from column 12 on `step` further away.
kernels::ScreenSpacePicture two_planes(double step) {
  kernels::ScreenSpacePicture picture;
  picture.width = picture.height = 24;
  picture.depth_offset = 0.5;
  picture.sums.resize(576, {0.5, 0.5, 0.5, 1});
  picture.normalized.resize(576, glm::dvec3(0.5));
  for (std::size_t i = 0; i < 576; ++i) picture.depth.push_back(i % 24 < 12 ? 2 : 2 + step);
  return picture;
}

TEST(ReferenceComparison, TellsPixelsOffEdgesApart) {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  Frame frame(24, 24, formats);
  for (Vec4& color : frame.colors32) color = {0.5f, 0.5f, 0.5f, 1};
  frame.colors32[24 * 12 + 6] = {0.6f, 0.5f, 0.5f, 1};  // off edges
  frame.colors32[24 * 12 + 7] = {0, 0, 0, 1};           // four pixels from the jump
  const Comparison jump = compare(frame, two_planes(1.01));
  EXPECT_EQ(jump.pixels_off_edges, 4u * 14);  // columns 5, 6, 17 and 18 of rows 5 to 18
  EXPECT_NEAR(jump.psnr_off_edges, -10 * std::log10(0.01 / (3.0 * 56)), 1e-4);
  const Comparison slope = compare(frame, two_planes(0.99));
  EXPECT_EQ(slope.pixels_off_edges, 14u * 14);
  EXPECT_NEAR(slope.psnr_off_edges, -10 * std::log10((0.01 + 0.75) / (3.0 * 196)), 1e-4);
}

TEST(ReferenceComparison, SaysSoWhereNothingIsCovered) {
  EXPECT_EQ(describe_psnr({.surface_pixels = 12, .psnr = 40.06}), "PSNR 40.1 dB over 12 pixels");
  kernels::SplatSums nothing = grey_square();
  for (auto& sum : nothing.sums) sum = {};
  EXPECT_TRUE(std::isnan(psnr(grey_frame(), nothing)));
  EXPECT_EQ(describe_psnr({}), "no pixel is covered");
}

TEST(ReferenceComparison, MapsHaveNames) {
  EXPECT_EQ(screen_map_by_name("affine"), kernels::ScreenMap::affine);
  EXPECT_EQ(screen_map_by_name("perspective"), kernels::ScreenMap::perspective);
  EXPECT_THROW(screen_map_by_name("exact"), UserError);
}

TEST(ReferenceComparison, DifferencePictureIsGreyWhereTheyAgree) {
  Frame frame = grey_frame();
  frame.colors32[7] = {0.51f, 0.5f, 0.4f, 1};
  frame.colors32[0] = {-0.5f, 0, 0, 0};  // shown as black
  const Image image = difference_picture(frame, grey_square());
  EXPECT_EQ(image.pixels[0], (std::array<float, 4>{0.5f, 0.5f, 0.5f, 1}));
  EXPECT_NEAR(image.pixels[7][0], 0.66f, 1e-5);
  EXPECT_EQ(image.pixels[7][1], 0.5f);
  EXPECT_EQ(image.pixels[7][2], 0.0f);
}

// What the volume lets through is its background: all of it beside the volume, little in its middle.
TEST(ReferenceComparison, AVolumeLiesOverItsBackground) {
  const auto picture = [](const char* background) {
    const std::string text =
        std::string("[volume]\ngenerator = \"head\"\nvoxels = [16, 16, 16]\nbackground = ") + background +
        "\n[frame]\nwidth = 16\nheight = 16\n";
    return volume_reference(traces::parse_volume_scene(text, "head.toml")).normalized;
  };
  const auto black = picture("[0, 0, 0]"), blue = picture("[0, 0, 0.5]");
  EXPECT_EQ(blue[0] - black[0], glm::dvec3(0, 0, 0.5));
  EXPECT_EQ(blue[8 * 16 + 8].r, black[8 * 16 + 8].r);
  EXPECT_LT(blue[8 * 16 + 8].b - black[8 * 16 + 8].b, 0.25);
}

}  // namespace
}  // namespace splatscope::studies
