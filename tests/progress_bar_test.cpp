#include "app/progress_bar.h"

#include <gtest/gtest.h>

#include <limits>

namespace splatscope::app {
namespace {

TEST(ProgressBar, TellsTheTimeThatIsLeft) {
  EXPECT_EQ(time_left(65, 0.5), "1:05 left");
  EXPECT_EQ(time_left(1, 0.99), "0:00 left");
  EXPECT_EQ(time_left(10, 0.1), "1:30 left");
  EXPECT_EQ(time_left(3600, 0.25), "3:00:00 left");
  EXPECT_EQ(time_left(100, 1.5), "0:00 left");
}

TEST(ProgressBar, TellsNoTimeWhileNothingTellsIt) {
  EXPECT_EQ(time_left(0.5, 0.5), "");
  EXPECT_EQ(time_left(60, 0), "");
  EXPECT_EQ(time_left(60, 1e-9), "");
  EXPECT_EQ(time_left(60, std::numeric_limits<double>::quiet_NaN()), "");
}

}  // namespace
}  // namespace splatscope::app
