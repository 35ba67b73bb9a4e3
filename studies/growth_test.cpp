#include "studies/growth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/testing/sanitized.h"
#include "model/testing/scratch_folder.h"
#include "studies/peak_memory.h"

namespace splatscope::studies {
namespace {

TEST(Growth, TheSlopeIsThatOfThePowerLaw) {
  EXPECT_NEAR(log_log_slope({1, 10, 100}, {3, 30, 300}), 1, 1e-12);
  EXPECT_NEAR(log_log_slope({1, 4, 9, 16}, {5, 10, 15, 20}), 0.5, 1e-12);
  // Two points above and one below a line of slope 1, in logarithms of 10: (0, 0.1), (1, 0.9), (2, 2.1).
  EXPECT_NEAR(log_log_slope({1, 10, 100}, {std::pow(10, 0.1), std::pow(10, 0.9), std::pow(10, 2.1)}), 1,
              1e-12);
}

TEST(Growth, AFixedPartAndALinearOneAreFound) {
  const std::vector<double> x{10, 100, 1000};
  const FixedAndLinear exact = fixed_and_linear(x, {25, 70, 520});  // 20 + x / 2
  EXPECT_NEAR(exact.fixed, 20, 1e-9);
  EXPECT_NEAR(exact.linear, 0.5, 1e-12);
  EXPECT_NEAR(exact.worst, 0, 1e-12);
  // What grows faster has no fixed part below 0, and what shrinks no linear one: the best multiple of x, and
  // the best constant, of 1 : 100 and of 100 : 1.
  const FixedAndLinear faster = fixed_and_linear({1, 10}, {1, 100});
  EXPECT_EQ(faster.fixed, 0);
  EXPECT_NEAR(faster.linear, 1.1 / 1.01, 1e-12);
  EXPECT_NEAR(faster.worst, 1 - 0.1 * faster.linear, 1e-12);
  const FixedAndLinear shrinking = fixed_and_linear({1, 10}, {100, 1});
  EXPECT_EQ(shrinking.linear, 0);
  EXPECT_NEAR(shrinking.fixed, 1.01 / 1.0001, 1e-12);
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
  }
  EXPECT_GT(rows[1].cycle.seconds, rows[0].cycle.seconds);
  if (!restart_peak_memory()) GTEST_SKIP() << "the system does not tell the peak of the memory";
  for (const GrowthRow& row : rows)  // the recording is gone, the trace is not
    EXPECT_GT(row.functional.megabytes, row.trace_megabytes / 2);
  EXPECT_GT(rows[1].trace_megabytes, rows[0].trace_megabytes);
  EXPECT_GT(rows[1].cycle.megabytes, rows[0].cycle.megabytes);
  if (kSanitized) return;  // whose own memory grows with the program's
  // At most 1 KiB a surfel beyond what is the same for any number: what is asked of a million.
  const double more = rows[1].functional.megabytes - rows[0].functional.megabytes;
  EXPECT_LT(1e6 * more, 1024.0 * (rows[1].surfels - rows[0].surfels));
}

TEST(Growth, AMeasureThatTheSystemDoesNotTellIsLeftOut) {
  const ScratchFolder folder;
  std::vector<GrowthRow> rows(2);
  for (GrowthRow& row : rows) {
    row.surfels = &row == &rows[0] ? 100 : 1000;
    for (FrameCost* cost : {&row.functional, &row.sampled, &row.cycle}) cost->seconds = row.surfels;
    row.functional.megabytes = row.surfels;
  }
  rows[1].sampled.megabytes = 1;
  rows[1].trace_megabytes = -1;
  Findings findings(folder.path(), "growth", "");
  add_growth_report(findings, rows);
  findings.write(1);
  const auto measures = nlohmann::json::parse(text_of(folder / "results.json"))["growth"]["measures"];
  EXPECT_EQ(measures.size(), 4u) << measures;
  for (const char* name : {"functional, s", "sampled, s", "cycle, s", "functional, MB"}) {
    EXPECT_NEAR(measures.at(name)["log_log_slope"].get<double>(), 1, 1e-12) << name;
    EXPECT_NEAR(measures.at(name)["per_surfel"].get<double>(), 1, 1e-12) << name;
  }
  EXPECT_EQ(text_of(folder / "report.html").find("trace, MB"), std::string::npos);
}

}  // namespace
}  // namespace splatscope::studies
