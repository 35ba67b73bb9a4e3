#include "studies/fidelity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "studies/peak_memory.h"

namespace splatscope::studies {
namespace {

TEST(FidelityStudy, EveryFidelityStandsBesideTheReferee) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 40\nrows = 40\n[frame]\nwidth = 96\nheight = 96\n"
      "[capture]\nviews = 2\nframe_size = 96\n",
      "plane");
  const std::vector<FidelityRow> rows = fidelity_rows(scene, 1);
  ASSERT_EQ(10u, rows.size());
  for (const FidelityRow& row : rows) {
    SCOPED_TRACE(std::string(name(row.fidelity)) + " on " + row.machine);
    EXPECT_GT(row.host_seconds, 0);
    EXPECT_EQ(row.cycles == 0, row.fidelity == Fidelity::functional);
    EXPECT_EQ(row.units.empty(), row.fidelity == Fidelity::functional);
    EXPECT_LT(std::abs(row.error), 0.1);
    if (row.fidelity == Fidelity::throughput) {
      EXPECT_NE(row.error, 0);
    }
    // This plane is too small to be sampled: it is simulated whole.
    if (row.fidelity > Fidelity::throughput) {
      EXPECT_EQ(row.error, 0);
      for (const auto& unit : row.units) EXPECT_EQ(unit.error, 0) << unit.unit;
    }
  }
}

TEST(PeakMemory, GrowsWithWhatIsTakenAndStartsAgain) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's own memory grows with the program's";
#endif
  if (!restart_peak_memory()) GTEST_SKIP() << "the system does not reset the peak";
  const std::size_t before = peak_memory();
  constexpr std::size_t kBytes = 64 << 20;
  std::vector<char>(kBytes, 1).back() = 2;
  // The system counts in batches of pages.
  EXPECT_NEAR(static_cast<double>(peak_memory()), static_cast<double>(before + kBytes), 4 << 20);
  ASSERT_TRUE(restart_peak_memory());
  EXPECT_NEAR(static_cast<double>(peak_memory()), static_cast<double>(before), 4 << 20);
}

}  // namespace
}  // namespace splatscope::studies
