// Table 1 of Ren 2002 on the simulated machines: within what the reproduction promises of the published
// figures.
#include "studies/reproduction/table1.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/machine/machine.h"

namespace splatscope::studies {
namespace {

TEST(Table1, SimulatedRatesComeNearThePublishedOnes) {
  const std::vector<Table1Row> rows = table1_rows();
  ASSERT_EQ(6u, rows.size());
  for (const Table1Row& row : rows) {
    SCOPED_TRACE(row.algorithm + " on " + row.machine);
    EXPECT_EQ(13, row.visibility_slots);
    EXPECT_EQ(row.algorithm == "no-ewa" ? 21 : 78, row.splat_slots);
    // The per-pixel rows are published with two digits: 1.0 and 1.3.
    EXPECT_LT(std::abs(row.error()), row.algorithm == "ewa-per-pixel" ? 0.10 : 0.05);
  }
}

}  // namespace
}  // namespace splatscope::studies
