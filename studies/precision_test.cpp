#include "studies/precision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/testing/scratch_folder.h"

namespace splatscope::studies {
namespace {

Switch switch_of(std::string_view step, std::string_view level) {
  for (const Switch& one : precision_switches()) {
    if (one.step == step && one.level == level) return one;
  }
  ADD_FAILURE() << "no switch " << step << " " << level;
  return {};
}

// On a small plane: an exact pipeline is near the reference, the machine is not, and each step costs
// something.
TEST(Precision, steps_cost_what_they_drop) {
  const std::vector<PrecisionScene> scenes{precision_plane(45, 32, 64)};
  const std::vector<Switch> switches{switch_of("nothing", ""),        switch_of("texel bits", "4"),
                                     switch_of("texel bits", "8"),    switch_of("texture size", "16"),
                                     switch_of("frame", "8 bits"),    switch_of("frame", "8 bits, truncated"),
                                     switch_of("RCP, RSQ bits", "8"), switch_of("sub-pixel bits", "0")};
  const auto rows = switch_rows(switches, scenes);
  const auto alone = [&](std::size_t i) { return rows[i].alone[0]; };
  EXPECT_GT(alone(0).psnr, 50);
  EXPECT_LT(rows[0].in_machine[0].psnr, alone(0).psnr - 3);
  EXPECT_LT(alone(1).psnr, alone(2).psnr) << "4-bit texels";
  EXPECT_LT(alone(3).psnr, alone(0).psnr - 3) << "a texture of 16 texels";
  EXPECT_LT(alone(5).psnr, alone(4).psnr) << "truncated";
  Pipeline wide = ideal_pipeline();
  wide.numbers.frame = FrameFormat::unorm16;
  wide.gamma = 0.6;  // no sum passes 1, where it is cut
  EXPECT_NEAR(errors_of(draw(scenes[0].scene, wide), scenes[0].reference).psnr, alone(0).psnr, 0.05);
  EXPECT_LT(alone(6).psnr, alone(0).psnr - 3) << "reciprocals of 8 bits";
  EXPECT_LT(alone(7).psnr, alone(0).psnr) << "whole pixels";
}

// Rounding to nearest loses what is under half a step, truncation more; wide and dithered frames keep it.
TEST(Precision, many_small_splats_vanish_in_eight_bits) {
  const double overlaps[] = {4, 16, 300};
  const auto rows = overlap_rows(overlaps, 96);
  const auto bias = [&](std::string_view frame, double count) {
    return std::ranges::find_if(rows,
                                [&](const OverlapRow& r) { return r.frame == frame && r.overlaps == count; })
        ->bias;
  };
  EXPECT_LT(bias("unorm8, truncate", 300), -150);
  EXPECT_NEAR(bias("unorm8, truncate", 16), -0.5 * 16, 0.3) << "half a step a splat";
  EXPECT_GT(std::abs(bias("unorm8, nearest", 300)), 10);
  for (const double count : overlaps) {
    EXPECT_LT(std::abs(bias("unorm16, nearest", count)), 0.5) << count;
    EXPECT_LT(std::abs(bias("float32", count)), 0.5) << count;
  }
  for (const OverlapRow& row : rows) {
    if (row.frame.starts_with("unorm8")) continue;
    EXPECT_EQ(row.saturated, 0) << row.frame;
  }
}

TEST(Precision, a_depth_offset_is_for_curved_surfaces) {
  const double offsets[] = {0.125, 1, 8};
  const auto rows = depth_rows(offsets, 128);
  ASSERT_EQ(rows.size(), 9u);
  const DepthRow* const z16 = &rows[0];
  const DepthRow* const z24 = &rows[3];
  EXPECT_GT(z24[0].lost, z16[0].lost + 0.05);
  EXPECT_LT(z24[1].lost, 0.01);
  EXPECT_EQ(z24[1].leaks, 0);
  EXPECT_GT(z24[2].leaks, 0.9) << "further than the surface behind";
}

// Lines of docs/precision.md, made again for the first of its scenes.
TEST(Precision, the_documentation_holds) {
  const std::string page = text_of(SPLATSCOPE_SOURCE "/docs/precision.md");
  const std::vector<PrecisionScene> scenes{precision_plane(0, 128, 256)};
  const std::vector<Switch> switches{switch_of("nothing", ""), switch_of("texel bits", "8"),
                                     switch_of("sub-pixel bits", "4"), switch_of("frame", "10 bits")};
  for (const SwitchRow& row : switch_rows(switches, scenes)) {
    EXPECT_NE(page.find(line_of(row)), std::string::npos) << line_of(row);
  }
}

}  // namespace
}  // namespace splatscope::studies
