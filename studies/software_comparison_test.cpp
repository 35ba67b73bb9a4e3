#include "studies/software_comparison.h"

#include <gtest/gtest.h>

#include <array>

namespace splatscope::studies {
namespace {

TEST(SoftwareComparison, GrowthIsTheSlopeOverPixels) {
  const std::array rows = {SoftwareRow{"a", 256, 1.0, 0}, SoftwareRow{"b", 256, 3.0, 0},
                           SoftwareRow{"a", 512, 4.0, 0}, SoftwareRow{"b", 512, 6.0, 0}};
  EXPECT_NEAR(1.0, growth(rows, "a"), 1e-12) << "four times the pixels, four times the time";
  EXPECT_NEAR(0.5, growth(rows, "b"), 1e-12);
}

TEST(SoftwareComparison, DrawsEveryResolutionByEveryRenderer) {
  const traces::Scene scene = traces::parse_scene(
      "surfels = { generator = \"sphere\", count = 2000 }\n[capture]\nviews = 1\nframe_size = 64\n",
      "sphere");
  const auto rows = software_rows(scene, std::array{32, 128}, 1, Fidelity::throughput);
  ASSERT_EQ(8u, rows.size());
  for (const SoftwareRow& row : rows) {
    EXPECT_GT(row.seconds, 0) << row.renderer;
    EXPECT_NEAR(2000, row.splats_per_second * row.seconds, 1e-6);
  }
  // The paper's finding: vertices bound the machine, whatever the pixels.
  EXPECT_LT(growth(rows, machine::kRadeon8500), 0.5);
}

}  // namespace
}  // namespace splatscope::studies
