#include "traces/volume_sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <numeric>

#include "model/stop.h"

namespace splatscope::traces {
namespace {

const kernels::View kView = kernels::look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}, 30, 64, 64, 1, 10);
constexpr double kCutoff = 4;

// Of a circle of 2 pixels standard deviation.
HostVoxel voxel(float x, float y, float opacity) {
  HostVoxel voxel;
  voxel.drawn = true;
  voxel.weight = voxel.opacity = opacity;
  voxel.low = {x - 4, y - 4};
  voxel.high = {x + 4, y + 4};
  voxel.conic = {0.25f, 0, 0.25f};
  return voxel;
}

SheetPlan planned(const std::vector<HostVoxel>& voxels, bool gains = true) {
  SheetPlanner planner{kView, kCutoff, gains, true};
  for (const HostVoxel& v : voxels)
    planner.heaviest = std::max(planner.heaviest, static_cast<double>(v.weight));
  std::vector<std::uint32_t> numbers(voxels.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return planner.plan(voxels, numbers);
}

TEST(VolumeSheets, TheLargestSumComesToAlmostOne) {
  const SheetPlan plan = planned({voxel(20.5f, 20.5f, 0.1f), voxel(22.5f, 20.5f, 0.1f)});
  const double sum = 2 * 0.1 * std::exp(-0.125);  // between the centres, half a standard deviation away
  EXPECT_EQ(plan.composite, std::ceil(255 * sum / 0.96));
  EXPECT_DOUBLE_EQ(plan.gain[0], 255.0 / plan.composite);
  EXPECT_LE(plan.gain[0] * sum, 0.96);
  EXPECT_EQ(plan.rescale, (std::array{255, 255, 255, 255}));
}

// A faint voxel far from an opaque one has a gain of its own, and the whole of 1/255 leads from one to the
// other: nothing but the sheet is rounded.
TEST(VolumeSheets, FaintVoxelsHaveMoreGain) {
  const SheetPlan plan = planned({voxel(20.5f, 20.5f, 0.8f), voxel(40.5f, 40.5f, 0.03f)});
  EXPECT_EQ(plan.composite, 213);
  EXPECT_EQ(plan.voxels[0][kSharedVariance], std::vector<std::uint32_t>{0});
  EXPECT_EQ(plan.voxels[2][kSharedVariance], std::vector<std::uint32_t>{1});
  for (std::size_t level = 1; level < kVoxelLevels; ++level)
    EXPECT_DOUBLE_EQ(plan.gain[level], plan.gain[level - 1] * 255 / plan.rescale[level - 1]);
  EXPECT_GT(plan.gain[2] * 0.03, 0.7);
  EXPECT_LE(plan.gain[2] * 0.03, 0.9601);
}

TEST(VolumeSheets, StopWhereTheyAreAskedTo) {
  stop_signal = SIGINT;
  EXPECT_THROW(planned({voxel(20.5f, 20.5f, 0.8f)}), Interrupted);
  stop_signal = 0;
}

TEST(VolumeSheets, WithoutGainsNothingIsScaled) {
  const SheetPlan plan = planned({voxel(20.5f, 20.5f, 0.8f), voxel(40.5f, 40.5f, 0.03f)}, false);
  EXPECT_EQ(plan.composite, 255);
  EXPECT_EQ(plan.rescale, (std::array{255, 255, 255, 255}));
  EXPECT_EQ(plan.gain, (std::array<double, kVoxelLevels>{1, 1, 1, 1}));
}

// More than 1 saturates, as the sheet does by itself.
TEST(VolumeSheets, SumsAboveOneAreLeftAlone) {
  const SheetPlan plan = planned({voxel(20.5f, 20.5f, 0.9f), voxel(20.5f, 20.5f, 0.9f)});
  EXPECT_EQ(plan.composite, 255);
  EXPECT_EQ(plan.gain[0], 1);
}

TEST(VolumeSheets, RectanglesKeepToTheFrame) {
  const SheetPlan plan = planned({voxel(1, 62, 0.5f), voxel(30, 40, 0.5f)});
  EXPECT_EQ(plan.rectangle.left, 0);
  EXPECT_EQ(plan.rectangle.top, 35);
  EXPECT_EQ(plan.rectangle.right, 35);
  EXPECT_EQ(plan.rectangle.bottom, 64);
  std::vector<HostVoxel> hidden{voxel(30, 40, 0.5f)};
  hidden[0].drawn = false;
  EXPECT_TRUE(planned(hidden).rectangle.empty());
}

// In the middle of one voxel another of half its opacity, three pixels away in x and y, is beyond its cutoff
// (r = 4.5); half-way each has its part, 0.2 exp(-0.25) + 0.1 exp(-1) = 0.193, which is less.
TEST(VolumeSheets, VoxelsEndAtTheirCutoff) {
  EXPECT_EQ(planned({voxel(20.5f, 20.5f, 0.2f), voxel(23.5f, 23.5f, 0.1f)}).composite,
            std::ceil(255 * 0.2 / 0.96));
}

// 255 (255 / 213) 0.6 / 0.96 = 191 of 255: little gain for a pass over the sheet.
TEST(VolumeSheets, ALittleGainIsNotWorthAPass) {
  std::vector<HostVoxel> voxels(5, voxel(40.5f, 40.5f, 0.15f));
  voxels[0] = voxel(20.5f, 20.5f, 0.8f);
  const SheetPlan plan = planned(voxels);
  EXPECT_EQ(plan.voxels[1][kSharedVariance].size(), 4u);
  EXPECT_EQ(plan.rescale, (std::array{255, 255, 255, 255}));
}

TEST(VolumeSheets, ALevelBeginsAtAQuarterOfTheOneBefore) {
  const SheetPlanner planner{kView, kCutoff, true, true, 0.5};
  EXPECT_EQ(planner.level_of(0.126), 0u);
  EXPECT_EQ(planner.level_of(0.125), 1u);
  EXPECT_EQ(planner.level_of(1e-9), kVoxelLevels - 1);
}

}  // namespace
}  // namespace splatscope::traces
