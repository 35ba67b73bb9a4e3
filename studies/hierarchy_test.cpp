#include "studies/hierarchy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "traces/hierarchy/block_choice.h"
#include "traces/splat_trace.h"

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
  const traces::Scene scene = small_sphere();
  const auto chosen =
      traces::choose_blocks(traces::build_ldc_tree(scene.surfels, scene.hierarchy.block_surfels),
                            traces::view_of(scene.camera, scene.frame), scene.splatting, scene.hierarchy);
  EXPECT_EQ(chosen[0].counts.blocks, row.blocks);
  EXPECT_EQ(chosen[0].ranges.size(), row.draws) << "blocks that follow each other are one draw of a pass";
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
  EXPECT_NEAR(near.spacing_pixels, 8 * far.spacing_pixels, 1e-9);
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
  // The last frame is that of the finest level alone.
  const CullingRow finest = culling_row(small_sphere(), machine::load(machine::kGeForce4));
  EXPECT_NEAR(rows.back().milliseconds * finest.fps, 1000, 1);
  // Over the pixels that one of the two drew on: nothing else is seen.
  const Image &first = rows.front().picture, &last = rows.back().picture;
  std::vector<unsigned char> drawn;
  for (std::size_t i = 0; i < last.pixels.size(); ++i)
    drawn.push_back(first.pixels[i][1] > 0 || last.pixels[i][1] > 0);
  EXPECT_NEAR(rows.front().psnr, psnr(first, last, drawn), 0.01);
}

// An eye in the origin that sees 45 degrees to each side, from 1 to 10: of a surfel on every side of that,
// two inside.
TEST(Hierarchy, ASurfelIsClassifiedByItsCentreAndItsNormal) {
  traces::Scene scene;
  scene.camera = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90, 1, 10};
  scene.frame = {64, 64};
  for (const glm::vec3 position : {glm::vec3(0, 0, 0.9f),
                                   {0, 0, 10.1f},
                                   {5.1f, 0, 5},
                                   {-5.1f, 0, 5},
                                   {0, 5.1f, 5},
                                   {0, -5.1f, 5},
                                   {4.9f, 0, 5},
                                   {0, -4.9f, 5}})
    scene.surfels.push_back({position, {0, 0, -1}, 1, {}});
  EXPECT_EQ(classify(scene).outside, 6u);
  EXPECT_EQ(classify(scene).facing_away, 0u);
  scene.surfels.back().normal = {0, 0, 1};
  scene.surfels.front().normal = {0, 0, 1};  // outside, and not asked
  EXPECT_EQ(classify(scene).outside, 6u);
  EXPECT_EQ(classify(scene).facing_away, 1u);
}

}  // namespace
}  // namespace splatscope::studies
