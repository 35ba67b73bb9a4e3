#include "studies/volume_ripple.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/reference/volume/volume_rendering.h"

namespace splatscope::studies {
namespace {

// The Gaussians of variance 1 + 1 / pitch^2 on a grid of spacing 1, each cut off at r^2 = 4 variances, where
// the share e^(-2) of it is left out, and scaled to 1: how far their sum is from 1 at the most, anywhere in a
// cell.
double largest_deviation(double pitch) {
  const double variance = 1 + 1 / (pitch * pitch);
  double most = 0;
  for (int place = 0; place < 64 * 64; ++place) {
    const double x = place % 64 / 64.0, y = place / 64 / 64.0;
    double sum = 0;
    for (int i = -4; i <= 5; ++i) {
      for (int j = -4; j <= 5; ++j) {
        const double r = ((x - i) * (x - i) + (y - j) * (y - j)) / variance;
        if (r < 4) sum += std::exp(-0.5 * r) / (2 * std::numbers::pi * variance * (1 - std::exp(-2)));
      }
    }
    most = std::max(most, std::abs(sum - 1));
  }
  return most;
}

TEST(VolumeRipple, IsThatOfTheSumOfTruncatedGaussians) {
  for (const double pitch : {2.11, 9.7})
    EXPECT_NEAR(layer_ripple(4, pitch), largest_deviation(pitch), 5e-4) << pitch;
}

TEST(VolumeRipple, IsSmallAtTheDefaultCutoffAndLargeAtThePapers) {
  const double cutoff = kernels::VolumeSettings{}.cutoff;
  for (const double pitch : {1.03, 2.11}) {
    EXPECT_LT(layer_ripple(cutoff, pitch), 0.0025) << pitch;
    EXPECT_GT(layer_ripple(4, pitch), 0.02) << pitch;
    EXPECT_LT(layer_ripple(30, pitch), 1e-5) << pitch;  // of whole Gaussians: 2 e^(-2 pi^2) an axis
  }
}

}  // namespace
}  // namespace splatscope::studies
