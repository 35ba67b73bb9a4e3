#include "studies/growth.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splatscope::studies {
namespace {

TEST(Growth, TheSlopeIsThatOfThePowerLaw) {
  EXPECT_NEAR(log_log_slope({1, 10, 100}, {3, 30, 300}), 1, 1e-12);
  EXPECT_NEAR(log_log_slope({1, 4, 9, 16}, {5, 10, 15, 20}), 0.5, 1e-12);
  // Two points above and one below a line of slope 1, in logarithms of 10: (0, 0.1), (1, 0.9), (2, 2.1).
  EXPECT_NEAR(log_log_slope({1, 10, 100}, {std::pow(10, 0.1), std::pow(10, 0.9), std::pow(10, 2.1)}), 1,
              1e-12);
}

TEST(Growth, MoreSurfelsTakeMoreTimeAndMemory) {
  const int sides[] = {20, 120};
  const std::vector<GrowthRow> rows = growth_rows(sides);
  ASSERT_EQ(2u, rows.size());
  EXPECT_EQ(400, rows[0].surfels);
  EXPECT_EQ(14400, rows[1].surfels);
  for (const GrowthRow& row : rows) {
    EXPECT_GT(row.functional.seconds, 0);
    EXPECT_GT(row.sampled.seconds, 0);
    EXPECT_GE(row.functional.megabytes, row.trace_megabytes / 2);  // the recording is gone, the trace is not
  }
  EXPECT_GT(rows[1].cycle.seconds, rows[0].cycle.seconds);
  EXPECT_GE(rows[1].trace_megabytes, rows[0].trace_megabytes);
  EXPECT_GE(rows[1].cycle.megabytes, rows[0].cycle.megabytes);
}

}  // namespace
}  // namespace splatscope::studies
