// Table 2 of Ren 2002 on the simulated machines, by throughput fidelity: what the reproduction promises.
#include "studies/reproduction/table2.h"

#include <gtest/gtest.h>

#include <map>

namespace splatscope::studies {
namespace {

class Table2 : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { rows_ = table2_rows(Fidelity::throughput); }
  static std::vector<Table2Row> rows_;

  static double fps(const std::string& model, int resolution, const std::string& machine) {
    for (const Table2Row& row : rows_) {
      if (row.model == model && row.resolution == resolution && row.machine == machine)
        return row.simulated_fps;
    }
    ADD_FAILURE() << "no row " << model << " " << resolution << " " << machine;
    return 0;
  }
};
std::vector<Table2Row> Table2::rows_;

TEST_F(Table2, ComesNearThePublishedRates) {
  ASSERT_EQ(16u, rows_.size());
  for (const Table2Row& row : rows_) {
    EXPECT_LT(std::abs(row.error()), 0.35) << row.model << " " << row.resolution << " on " << row.machine;
  }
  EXPECT_LT(median_error(rows_), 0.15);
}

TEST_F(Table2, HasExactlyThePublishedPoints) {
  for (const Table2Row& row : rows_) {
    for (const Table2Model& model : table2_models()) {
      if (model.name == row.model) {
        EXPECT_EQ(model.points, row.points);
      }
    }
    EXPECT_LT(row.drawn, row.points) << row.model << ": culling leaves out";
  }
}

TEST_F(Table2, KeepsThePublishedOrder) {
  for (const Table2Model& model : table2_models()) {
    const std::string name(model.name);
    for (const char* machine : {"radeon-8500", "geforce4-ti4400"}) {
      EXPECT_LT(fps(name, 512, machine), fps(name, 256, machine)) << name << ": more pixels take longer";
    }
    for (const int resolution : {256, 512}) {
      EXPECT_LT(fps(name, resolution, "radeon-8500"), fps(name, resolution, "geforce4-ti4400")) << name;
    }
  }
  for (const int resolution : {256, 512}) {
    for (const char* machine : {"radeon-8500", "geforce4-ti4400"}) {
      EXPECT_GT(fps("salamander", resolution, machine), fps("chameleon", resolution, machine));
      EXPECT_GT(fps("chameleon", resolution, machine), fps("wasp", resolution, machine));
      EXPECT_GT(fps("wasp", resolution, machine), fps("fiesta", resolution, machine));
    }
  }
}

}  // namespace
}  // namespace splatscope::studies
