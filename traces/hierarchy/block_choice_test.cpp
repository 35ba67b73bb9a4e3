#include "traces/hierarchy/block_choice.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/error.h"
#include "model/render.h"
#include "traces/framing.h"
#include "traces/recorder.h"
#include "traces/scene.h"

namespace splatscope::traces {
namespace {

// Normalised per pixel: no weights to capture.
Scene small_model(std::string_view hierarchy) {
  return parse_scene(
      fmt::format("[surfels]\ngenerator = \"torus-knot\"\ncount = 6000\n"
                  "[frame]\nwidth = 96\nheight = 96\n[splatting]\nalgorithm = \"ewa-per-pixel\"\n"
                  "[hierarchy]\nblock_surfels = 16\n{}",
                  hierarchy),
      "model.toml");
}

struct Choice {
  LdcTree tree;
  std::vector<ChosenFrame> frames;
};
Choice choose(const Scene& scene) {
  LdcTree tree = build_ldc_tree(scene.surfels, scene.hierarchy.block_surfels);
  std::vector<ChosenFrame> frames =
      choose_blocks(tree, view_of(scene.camera, scene.frame), scene.splatting, scene.hierarchy);
  return {std::move(tree), std::move(frames)};
}

// How often a frame shows each surfel of the finest level, at whatever level.
void mark(const LdcTree& tree, std::size_t level, const Block& block, std::vector<int>& shown) {
  for (std::uint32_t k = 0; level == 0 && k < block.count; ++k) ++shown[block.first + k];
  for (std::uint32_t child = 0; child < block.children; ++child)
    mark(tree, level - 1, tree.levels[level - 1].blocks[block.first_child + child], shown);
}
std::vector<int> shown(const LdcTree& tree, const ChosenFrame& frame) {
  std::vector<int> times(tree.levels.front().surfels.size());
  for (const BlockRange& range : frame.ranges)
    for (const Block& block : tree.levels[range.level].blocks)
      if (block.first >= range.first && block.first < range.first + range.count)
        mark(tree, range.level, block, times);
  return times;
}

// 90 degrees of view, 100 pixels each way: an eta of 50.
TEST(BlockChoice, SpacingIsWarpedToTheScreen) {
  const kernels::View view = kernels::look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90, 100, 100, 1, 1000);
  Block block;
  block.box = {{-1, -1, 10}, {1, 1, 10}};
  EXPECT_DOUBLE_EQ(0.1 * 50 / 10, projected_spacing(block, 0.1, view));
  block.box.high.z = 10 + 2;  // its diagonals are seen shorter than they are
  const double slanted = projected_spacing(block, 0.1, view);
  EXPECT_LT(slanted, 0.1 * 50 / 10);
  EXPECT_GT(slanted, 0.1 * 50 / 12 * std::sqrt(2.0 / 3.0));
  block.box.low.z = 0.5;  // before the near plane
  EXPECT_LT(projected_spacing(block, 0.1, view), 0.1 * 50 / 0.5);
  EXPECT_GT(projected_spacing(block, 0.1, view), slanted);
  block.box.low.z = -0.5;  // behind the eye
  EXPECT_EQ(std::numeric_limits<double>::infinity(), projected_spacing(block, 0.1, view));
  block.box = {{0, 0, 20}, {0, 0, 20}};
  EXPECT_DOUBLE_EQ(0.1 * 50 / 20, projected_spacing(block, 0.1, view));
}

TEST(BlockChoice, EachSurfelIsShownOnceAtSomeLevel) {
  Scene scene = small_model("culling = \"off\"\nlevel = \"auto\"\nsurfels_per_pixel = 0.005\n");
  scene.camera.target += glm::dvec3(0.3, 0, 0);  // near and far blocks
  scene.camera.eye = scene.camera.target + 0.3 * (scene.camera.eye - scene.camera.target);
  scene.camera.near *= 0.01;
  const Choice choice = choose(scene);
  ASSERT_EQ(1u, choice.frames.size());
  const BlockCounts& counts = choice.frames.front().counts;
  EXPECT_GT(std::ranges::count_if(counts.surfels_by_level, [](std::size_t n) { return n > 0; }), 1);
  for (const int times : shown(choice.tree, choice.frames.front())) ASSERT_EQ(1, times);
}

// Culled or shown, each surfel of the finest level is in one of the counts.
TEST(BlockChoice, CountsWhatCoarseBlocksStandFor) {
  Scene scene = small_model("culling = \"blocks\"\nlevel = \"auto\"\nsurfels_per_pixel = 0.02\n");
  scene.camera.eye = scene.camera.target + 0.4 * (scene.camera.eye - scene.camera.target);
  scene.camera.target += glm::dvec3(0.8, 0, 0);  // part of it is out of the frame
  scene.camera.near *= 0.01;
  const Choice choice = choose(scene);
  const ChosenFrame& frame = choice.frames.front();
  EXPECT_LT(frame.counts.surfels_by_level.front(), frame.counts.surfels);
  EXPECT_GT(frame.counts.outside_frustum, 0u);
  EXPECT_GT(frame.counts.facing_away, 0u);
  const auto shown_once = static_cast<std::size_t>(std::ranges::count(shown(choice.tree, frame), 1));
  EXPECT_EQ(shown_once + frame.counts.outside_frustum + frame.counts.facing_away, scene.surfels.size());
}

TEST(BlockChoice, BlocksThatFollowEachOtherAreOneRange) {
  const Choice all = choose(small_model("culling = \"off\"\n"));
  ASSERT_EQ(all.frames.front().ranges.size(), 1u);
  EXPECT_EQ(all.frames.front().ranges[0].count, 6000u);
  EXPECT_GT(all.frames.front().counts.blocks, 1u);
}

// A coarse block that faces away, one of whose surfels is so small that the pixel grid may turn it round,
// over one whose own cone tells nothing.
TEST(BlockChoice, WhatABlockTellsHoldsForThoseBelow) {
  const Surfel surfel{{0, 0, 20}, {0, 0, 1}, 1, {}};
  LdcTree tree{{TreeLevel{1, {surfel}, {}}, TreeLevel{2, {surfel}, {}}}, {0}};
  Block block;
  block.count = block.below = 1;
  block.box = {surfel.position, surfel.position};
  block.least_radius = block.greatest_radius = surfel.radius;
  block.axis = surfel.normal;
  block.behind = block.before = surfel.position;
  block.spread = 3;
  tree.levels[0].blocks = {block};
  block.spread = 0;
  block.least_radius = 1e-6;
  block.children = 1;
  tree.levels[1].blocks = {block};
  Splatting splatting;
  splatting.cutoff = splatting.sigma = splatting.depth_offset = 1;
  splatting.faces = Faces::front;
  Hierarchy hierarchy;
  hierarchy.culling = Culling::blocks;
  const kernels::View view = kernels::look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90, 500, 500, 1, 1000);
  EXPECT_EQ(choose_blocks(tree, view, splatting, hierarchy).front().counts.facing_away, 1u);
  tree.levels[1].blocks[0].spread = 3;
  EXPECT_EQ(choose_blocks(tree, view, splatting, hierarchy).front().counts.facing_away, 0u);
}

// Twice as far apart as those of the level below.
TEST(BlockChoice, TheDepthOffsetGrowsWithTheSpacing) {
  Splatting splatting;
  splatting.depth_offset = 0.5;
  for (const auto& [level, offset] : {std::pair(0u, 0.5), {1u, 1.0}, {3u, 4.0}})
    EXPECT_DOUBLE_EQ(level_splatting(splatting, level).depth_offset, offset);
}

TEST(BlockChoice, WhatIsFarIsDrawnCoarsely) {
  Scene scene = small_model("culling = \"off\"\nlevel = \"auto\"\n");
  const glm::dvec3 ray = scene.camera.eye - scene.camera.target;
  const std::size_t all = scene.surfels.size();
  std::size_t last = all + 1;
  for (const double distance : {0.2, 4.0, 16.0, 64.0}) {
    scene.camera.eye = scene.camera.target + distance * ray;
    place_planes(scene);
    // Through the nearest surfel, where it is before the eye: the near plane cuts boxes.
    const kernels::View view = view_of(scene.camera, scene.frame);
    scene.camera.near = view.camera_space(glm::dvec3(scene.surfels.front().position)).z;
    for (const Surfel& surfel : scene.surfels)
      scene.camera.near = std::min(scene.camera.near, view.camera_space(glm::dvec3(surfel.position)).z);
    const Choice choice = choose(scene);
    const std::size_t drawn = choice.frames.front().counts.surfels;
    EXPECT_LT(drawn, last) << distance;
    if (distance < 1) {
      EXPECT_EQ(all, drawn);
    }
    last = drawn;
    // Fine enough.
    for (const BlockRange& range : choice.frames.front().ranges) {
      const TreeLevel& level = choice.tree.levels[range.level];
      for (const Block& block : level.blocks) {
        if (block.first < range.first || block.first >= range.first + range.count || range.level == 0)
          continue;
        EXPECT_LE(projected_spacing(block, level.spacing, view_of(scene.camera, scene.frame)), 1);
      }
    }
  }
  EXPECT_LT(last, all / 50);
}

TEST(BlockChoice, ProgressiveFramesRefineToTheSamePicture) {
  const Scene whole = small_model(""), scene = small_model("progressive = true\n");
  const Choice choice = choose(scene);
  ASSERT_EQ(choice.tree.levels.size(), choice.frames.size());
  for (std::size_t i = 1; i < choice.frames.size(); ++i)
    EXPECT_GT(choice.frames[i].counts.surfels, choice.frames[i - 1].counts.surfels);
  EXPECT_EQ(choice.frames.back().counts.surfels, choice.frames.back().counts.surfels_by_level.front());

  RenderOptions options;
  options.record = Record::nothing;
  std::vector<splatscope::Frame> frames;
  const Recording recording = record(scene, options.formats);
  render(recording.trace, options, {}, [&](const splatscope::Frame& frame) { frames.push_back(frame); });
  ASSERT_EQ(choice.frames.size(), frames.size());
  EXPECT_EQ(render(record(whole, options.formats).trace, options).frame, frames.back());
  EXPECT_EQ(choice.frames.back().counts.surfels, recording.counts.surfels);
  // A coarse picture covers the model: as many pixels, but for what sticks out at the silhouette.
  const auto covered = [](const splatscope::Frame& frame) {
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < frame.depth.size(); ++pixel) count += frame.color(pixel)[3] > 0;
    return static_cast<double>(count);
  };
  for (const splatscope::Frame& frame : frames) EXPECT_GT(covered(frame), 0.9 * covered(frames.back()));
}

TEST(BlockChoice, WeightsOfTheFinestLevelAreNotEnoughForCoarserOnes) {
  Scene scene = small_model("progressive = true\n");
  const CapturedWeights weights = uniform_weights(scene.surfels.size(), 0.5);
  EXPECT_THROW(record(scene, weights), ModelError);
  scene.hierarchy.progressive = false;
  EXPECT_NO_THROW(record(scene, weights));
}

TEST(BlockChoice, NoSurfelsMakeAnEmptyFrame) {
  Scene scene = small_model("");
  scene.surfels.clear();
  const Recording recording = record(scene, NumberFormats{});
  EXPECT_EQ(1u, recording.trace.commands.size());
  EXPECT_EQ(0u, recording.counts.surfels);
}

}  // namespace
}  // namespace splatscope::traces
