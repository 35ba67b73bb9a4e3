#include "model/number/significand.h"

#include <gtest/gtest.h>

#include <limits>

namespace splatscope {
namespace {

TEST(Significand, RoundsToNearestEven) {
  EXPECT_EQ(rounded_significand(1 + 0x1p-23f, 24), 1 + 0x1p-23f);
  EXPECT_EQ(rounded_significand(1 + 0x1p-8f, 8), 1);  // a tie: to even
  EXPECT_EQ(rounded_significand(1 + 0x1p-7f + 0x1p-8f, 8), 1 + 0x1p-6f);
  EXPECT_EQ(rounded_significand(1 + 0x1p-8f + 0x1p-23f, 8), 1 + 0x1p-7f);
  EXPECT_EQ(rounded_significand(-(2 - 0x1p-23f), 8), -2);  // into the next power of two
  EXPECT_EQ(rounded_significand(0, 8), 0);
  EXPECT_EQ(rounded_significand(std::numeric_limits<float>::infinity(), 8),
            std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace splatscope
