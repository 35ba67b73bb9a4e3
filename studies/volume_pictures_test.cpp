#include "studies/volume_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/reference/volume/procedural.h"

namespace splatscope::studies {
namespace {

TEST(VolumePictures, WhatAPictureLetsThroughIsItsBackground) {
  const Image image = picture_of({.width = 1, .height = 1, .pixels = {{0.2f, 0.1f, 0, 0.75f}}}, {1, 0.4, 0});
  EXPECT_EQ(image.pixels[0], (std::array<float, 4>{0.45f, 0.2f, 0, 1}));
}

// Sample j lies at (j + 4) / 8 pixels: 0 to 3 in the first pixel, 4 to 11 in the second. Their numbers as
// values have the means 1.5 and 7.5; 100 times the row's is added.
TEST(VolumePictures, ABoxIsTheMeanOfAPixelsSamples) {
  Image fine(2 * kFiner, 2 * kFiner);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) fine.at(x, y)[0] = static_cast<float>(100 * y + x);
  const Image image = low_passed(fine, LowPass::box);
  ASSERT_EQ(image.width, 2);
  ASSERT_EQ(image.height, 2);
  EXPECT_NEAR(image.at(0, 0)[0], 151.5, 1e-3);
  EXPECT_NEAR(image.at(1, 0)[0], 157.5, 1e-3);
  EXPECT_NEAR(image.at(0, 1)[0], 751.5, 1e-3);
}

// A white column of samples in the middle of pixel 5, at 5.5 pixels, where j = 40: at a pixel's centre d
// pixels away it has exp(-d^2 / 2) / (8 sqrt(2 pi)), of a Gaussian of variance 1 in samples of 1/8.
TEST(VolumePictures, TheGaussianHasAVarianceOfOnePixel) {
  Image fine(11 * kFiner, kFiner);
  for (int y = 0; y < fine.height; ++y) fine.at(40, y)[1] = 1;
  const Image image = low_passed(fine, LowPass::gaussian);
  for (int x = 4; x < 7; ++x)
    EXPECT_NEAR(image.at(x, 0)[1], std::exp(-0.5 * (x - 5) * (x - 5)) / (8 * std::sqrt(2 * std::numbers::pi)),
                1e-5)
        << x;
}

// White rims about 2 x 3 pixels, of which one channel is 0.1 off.
TEST(VolumePictures, RimsOfAPictureAreNotCompared) {
  Image a(6, 7), b(6, 7);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 6; ++x)
      if (x < 2 || x > 3 || y < 2 || y > 4) a.at(x, y) = {1, 1, 1, 1};
  EXPECT_EQ(psnr_inside(a, b, 2), INFINITY);
  a.at(3, 4)[1] = 0.1f;
  EXPECT_NEAR(psnr_inside(a, b, 2), -10 * std::log10(0.01 / (3 * 6)), 1e-5);
  EXPECT_LT(psnr_inside(a, b, 1), 10);
}

// From above: an eye at z = 3 over the square at z = 1, with an angle of 90 degrees, sees x and y from -2 to
// 2. Stripes so wide that the square has one colour: a wave of sin(2 pi (0.8 x + 0.6 y + ...) / 1e3 ) / 0.3
// about 0, which is grey.
TEST(VolumePictures, TheZebraIsASquareOnItsBackground) {
  const kernels::View view = kernels::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 90, 16, 16, 0.1, 100);
  const Image image = zebra_picture(view, 1, 1e3, {0.25, 0.5, 1});
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      // Pixels of a quarter; the middle of the picture is half a pixel off.
      const bool inside = std::abs(x - 8) <= 4 && std::abs(y - 8) <= 4;
      EXPECT_NEAR(image.at(x, y)[0], inside ? 0.5 : 0.25, 0.02) << x << ' ' << y;
      EXPECT_NEAR(image.at(x, y)[2], inside ? 0.5 : 1, 0.02) << x << ' ' << y;
    }
  }
  // Two pixels right of the middle and one below, where x runs to the left.
  const Image stripes = zebra_picture(view, 1, 0.5, {0, 0, 0});
  EXPECT_NEAR(stripes.at(10, 9)[0], kernels::zebra(-0.5, -0.25, 0.5), 1e-6);
  const Image behind = zebra_picture(view, 4, 1e3, {0.25, 0.5, 1});
  for (const auto& pixel : behind.pixels) EXPECT_EQ(pixel, (std::array<float, 4>{0.25f, 0.5f, 1, 1}));
}

}  // namespace
}  // namespace splatscope::studies
