#include "model/number/frame_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace splatscope {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(FrameValue, UnormClampsAndRounds) {
  EXPECT_EQ(stored_value(FrameFormat::unorm10, 511.4f / 1023, 0.5), 511.0f / 1023);
  EXPECT_EQ(stored_value(FrameFormat::unorm10, 511.6f / 1023, 0.5), 512.0f / 1023);
  EXPECT_EQ(stored_value(FrameFormat::unorm10, 511.9f / 1023, 0), 511.0f / 1023);
  EXPECT_EQ(stored_value(FrameFormat::unorm16, 7, 0.5), 1);
  EXPECT_EQ(stored_value(FrameFormat::unorm8, -1, 0.5), 0);
  EXPECT_EQ(stored_value(FrameFormat::unorm16, kNaN, 0.5), 0);
}

// A product of two stored colours is rounded as its exact value is.
TEST(FrameValue, UnormRoundsProductsExactly) {
  for (int sum = 0; sum <= 255 * 255; ++sum) {
    const auto value = static_cast<float>(sum / (255.0 * 255));
    ASSERT_EQ(stored_value(FrameFormat::unorm8, value, 0), static_cast<float>(sum / 255 / 255.0)) << sum;
    ASSERT_EQ(stored_value(FrameFormat::unorm8, value, 0.5),
              static_cast<float>((2 * sum + 255) / 510 / 255.0))
        << sum;
  }
  for (int sum = 0; sum <= 1023 * 1023; ++sum) {
    const auto value = static_cast<float>(sum / (1023.0 * 1023));
    ASSERT_EQ(stored_value(FrameFormat::unorm10, value, 0.5),
              static_cast<float>((2 * sum + 1023) / 2046 / 1023.0))
        << sum;
  }
}

// What is stored stays: a splat of nothing changes no pixel, whatever the rounding.
TEST(FrameValue, StoredValuesAreFixedPoints) {
  for (const FrameFormat format : {FrameFormat::unorm8, FrameFormat::unorm10, FrameFormat::unorm16}) {
    const int steps = format == FrameFormat::unorm8 ? 255 : format == FrameFormat::unorm10 ? 1023 : 65535;
    for (int k = 0; k <= steps; ++k) {
      const auto value = static_cast<float>(k / static_cast<double>(steps));
      for (const double offset : {0.0, 0.5, 31.0 / 32}) {
        ASSERT_EQ(stored_value(format, value, offset), value) << k << " of " << steps;
      }
    }
  }
}

TEST(FrameValue, HalfRoundsToEvenAndKnowsItsRange) {
  EXPECT_EQ(stored_value(FrameFormat::half, 1 + 1.0f / 2048, 0.5), 1);
  EXPECT_EQ(stored_value(FrameFormat::half, 1 + 3.0f / 2048, 0.5), 1 + 2.0f / 1024);
  EXPECT_EQ(stored_value(FrameFormat::half, 2049, 0), 2048);
  EXPECT_EQ(stored_value(FrameFormat::half, 65519, 0.5), 65504);
  EXPECT_EQ(stored_value(FrameFormat::half, 65520, 0.5), kInfinity);
  EXPECT_EQ(stored_value(FrameFormat::half, std::ldexp(1.0f, -24), 0.5), std::ldexp(1.0f, -24));
  EXPECT_EQ(stored_value(FrameFormat::half, std::ldexp(0.5f, -24), 0.5), 0);
  EXPECT_EQ(stored_value(FrameFormat::float32, -3.0000002f, 0), -3.0000002f);
}

// Sixteen thresholds, each once in a tile, whose mean is a half: a dither has no bias over a tile.
TEST(FrameValue, DitherHasNoBias) {
  std::set<double> offsets;
  double sum = 0;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const double offset = rounding_offset(FrameRounding::dither, 4 + i % 4, 8 + i / 4);
    offsets.insert(offset);
    sum += offset;
  }
  EXPECT_EQ(offsets.size(), 16u);
  EXPECT_DOUBLE_EQ(sum, 8);
}

}  // namespace
}  // namespace splatscope
