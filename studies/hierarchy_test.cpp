#include "studies/hierarchy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splatscope::studies {
namespace {

traces::Scene small_sphere() {
  return traces::parse_scene(
      "surfels = { generator = \"sphere\", count = 4000 }\nframe = { width = 128, height = 128 }\n"
      "hierarchy.block_surfels = 16\n",
      "sphere.toml");
}

TEST(Hierarchy, CullsPartOfWhatFacesAwayAndGainsByIt) {
  const CullingRow row = culling_row(small_sphere(), machine::load(machine::kGeForce4));
  EXPECT_EQ(4000u, row.surfels);
  EXPECT_EQ(0u, row.could_go.outside);
  EXPECT_EQ(0u, row.outside);
  // The eye sees less than half of a sphere.
  EXPECT_GT(row.could_go.facing_away, row.surfels / 2);
  EXPECT_LT(row.facing_away, row.could_go.facing_away);
  EXPECT_GT(row.facing_away, row.could_go.facing_away / 10);
  EXPECT_GT(row.fps, row.fps_all);
}

// Where many surfels share a pixel, their small weights and dark colours round away: fewer and larger splats
// come nearer to all of them.
TEST(Hierarchy, ACoarseLevelIsNearerToTheReferenceFromAfar) {
  const traces::Scene scene = traces::parse_scene(
      "surfels = { generator = \"salamander\", count = 4000 }\nframe = { width = 80, height = 80 }\n"
      "hierarchy.block_surfels = 16\n",
      "salamander.toml");
  const Machine machine = machine::load(machine::kGeForce4);
  const LevelRow near = level_row(scene, 1, machine), far = level_row(scene, 8, machine);
  EXPECT_EQ(near.surfels, near.surfels_by_level.front());
  EXPECT_EQ(near.psnr_finest, near.psnr);
  EXPECT_LT(far.surfels, near.surfels / 8);
  EXPECT_GT(far.psnr, far.psnr_finest + 3);
  EXPECT_GT(near.psnr, far.psnr + 3);
}

TEST(Hierarchy, RefinesFrameByFrame) {
  const auto rows = progressive_rows(small_sphere(), machine::load(machine::kGeForce4));
  ASSERT_GT(rows.size(), 3u);
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_GT(rows[i].surfels, rows[i - 1].surfels);
  EXPECT_TRUE(std::isinf(rows.back().psnr));
  EXPECT_GT(rows.back().milliseconds, 2 * rows.front().milliseconds);
}

}  // namespace
}  // namespace splatscope::studies
