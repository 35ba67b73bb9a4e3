#include "traces/median.h"

#include <gtest/gtest.h>

#include <vector>

namespace splatscope::traces {
namespace {

double median_of(std::vector<double> values) {
  return median(std::span(values));
}

TEST(Median, IsTheMiddleOneOrTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(median_of({}), 0);
  EXPECT_EQ(median_of({7}), 7);
  EXPECT_EQ(median_of({9, 1}), 5);
  EXPECT_EQ(median_of({9, 1, 2}), 2);
  EXPECT_EQ(median_of({9, 1, 2, 4}), 3);
  EXPECT_EQ(median_of({5, 9, 1, 2, 4}), 4);
}

}  // namespace
}  // namespace splatscope::traces
