#include "traces/models/patterns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace splatscope::traces {
namespace {

TEST(Patterns, ACheckerIsSolid) {
  const auto is_light = [](double x, double y, double z) {
    return pattern_color(Pattern::checker, {x, y, z}, glm::vec3(1), glm::vec3(0)).r == 1;
  };
  EXPECT_TRUE(is_light(0.5, 0.5, 0.5));
  EXPECT_FALSE(is_light(-0.5, 0.5, 0.5));
  EXPECT_FALSE(is_light(0.5, 1.5, 0.5));
  EXPECT_FALSE(is_light(0.5, 0.5, -0.5));
  EXPECT_TRUE(is_light(0.5, -0.5, -0.5));
}

// In the corners of its cells any value from -1 to 1, each as likely: over 1000 of them, a mean of 0 within
// three of its standard deviations of 0.018.
TEST(Patterns, NoiseIsEvenFromMinusOneToOne) {
  double least = 1, most = -1, sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const double value = noise({i % 10, i / 10 % 10, i / 100});
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
  }
  EXPECT_GE(least, -1);
  EXPECT_LT(least, -0.98);
  EXPECT_LE(most, 1);
  EXPECT_GT(most, 0.98);
  EXPECT_NEAR(sum / 1000, 0, 0.055);
}

// Of points strewn one a unit of volume, the nearest is within 0.34 of a place with a chance of about
// 1 - exp(-4/3 pi 0.34^3) = 0.15, within 0.42 of 0.27: of dark spots and their rims.
TEST(Patterns, SpotsAreDarkWithNarrowRims) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-20, 20);
  int dark = 0, rim = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = any(random), y = any(random), z = any(random);
    const float light = pattern_color(Pattern::spots, {x, y, z}, glm::vec3(1), glm::vec3(0)).r;
    dark += light == 0;
    rim += light > 0 && light < 1;
  }
  EXPECT_NEAR(dark, 1500, 110);  // three standard deviations of 10,000 throws
  EXPECT_NEAR(rim, 1200, 100);
}

}  // namespace
}  // namespace splatscope::traces
