#include "model/number/ieee.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "model/testing/random_seed.h"

namespace splatscope::ieee {
namespace {

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}
float from(std::uint32_t value) {
  return std::bit_cast<float>(value);
}

TEST(Ieee, NanOfTheSecondOperandWins) {
  EXPECT_EQ(bits(add(from(0x7fc00001), from(0xffc00002))), 0xffc00002u);
  EXPECT_EQ(bits(multiply(from(0x7fc00001), 2.0f)), 0x7fc00001u);
  EXPECT_EQ(bits(multiply(INFINITY, 0.0f)), 0xffc00000u);
  EXPECT_EQ(bits(add(from(0x7f800001), 0.0f)), 0x7fc00001u) << "a signalling NaN is quieted";
}

TEST(Ieee, TheFractionOfANanIsThatNan) {
  for (const std::uint32_t nan : {0x7fc00001u, 0xffc00001u}) {
    EXPECT_EQ(bits(fraction(from(nan))), nan);
    EXPECT_EQ(bits(expp(from(nan))[1]), nan);
  }
  EXPECT_EQ(fraction(-1.25f), 0.75f);
}

TEST(Ieee, ReciprocalSqrtIsCorrectlyRounded) {
  std::mt19937 random(random_seed());
  for (int i = 0; i < 100000; ++i) {
    const float value = from(random() & 0x7f7fffffu);
    if (value == 0) continue;
    const long double exact = 1.0L / std::sqrt(static_cast<long double>(value));
    EXPECT_EQ(reciprocal_sqrt(value), static_cast<float>(exact)) << value;
    EXPECT_EQ(reciprocal_sqrt(-value), static_cast<float>(exact)) << value;
  }
}

TEST(Ieee, MultiplyAddIsNotFused) {
  const float a = 1.0f + 0x1p-12f;
  EXPECT_EQ(multiply_add(a, a, -1.0f - 0x1p-11f), 0.0f) << "fused it would be 2^-24";
}

}  // namespace
}  // namespace splatscope::ieee
