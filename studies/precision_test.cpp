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

// One level of each step, which leaves the machine's numbers as they are.
TEST(Precision, TheMachineHasOneLevelOfEachStep) {
  std::vector<std::string> levels;
  for (const Switch& one : precision_switches()) {
    if (!one.of_the_machine) continue;
    levels.push_back(one.step + " " + one.level);
    Pipeline pipeline = machine_pipeline();
    one.turn(pipeline);
    EXPECT_EQ(pipeline.numbers, machine_pipeline().numbers) << one.step << ' ' << one.level;
  }
  EXPECT_EQ(levels, (std::vector<std::string>{"nothing ", "texel bits 8", "texture size 438", "circle, c 1",
                                              "diffuse 8 bits", "combiner 9 bits", "frame 8 bits",
                                              "depth z24", "arithmetic nv20", "sub-pixel bits 4",
                                              "gamma, per pixel 0.73", "weights divided per pixel"}));
}

// On a small plane: an exact pipeline is near the reference, the machine is not, and each step costs
// something.
TEST(Precision, StepsCostWhatTheyDrop) {
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
TEST(Precision, ManySmallSplatsVanishInEightBits) {
  const double overlaps[] = {4, 16, 300};
  const auto rows = overlap_rows(overlaps, 96);
  const auto row_of = [&](std::string_view frame, double count) {
    return *std::ranges::find_if(
        rows, [&](const OverlapRow& r) { return r.frame == frame && r.overlaps == count; });
  };
  const auto bias = [&](std::string_view frame, double count) { return row_of(frame, count).bias; };
  EXPECT_LT(bias("unorm8, truncate", 300), -150);
  EXPECT_NEAR(bias("unorm8, truncate", 16), -0.5 * 16, 0.3) << "half a step a splat";
  EXPECT_GT(std::abs(bias("unorm8, nearest", 300)), 10);
  for (const double count : overlaps) {
    EXPECT_LT(std::abs(bias("unorm16, nearest", count)), 0.5) << count;
    EXPECT_LT(std::abs(bias("float32", count)), 0.5) << count;
  }
  // Of 300, the largest is 0.73 255 / 300 / (1 - 1/e) = 0.98 of a step in its middle, exp(-u) of that with u
  // even from 0 to 1: truncated nothing is left. At place i of 16 the dither rounds up what is over
  // 1 - (i + 0.5) / 16: from i = 9 on more than 255 of the 300, which is white, and hardly any at i = 0.
  EXPECT_EQ(row_of("unorm8, truncate", 300).black, 1);
  EXPECT_EQ(row_of("unorm8, dither", 300).saturated, 7.0 / 16);
  EXPECT_LT(row_of("unorm8, dither", 300).black, 1.0 / 16);
  EXPECT_EQ(row_of("float32", 4).black, 0);
  for (const OverlapRow& row : rows) {
    if (row.frame.starts_with("unorm8")) continue;
    EXPECT_EQ(row.saturated, 0) << row.frame;
  }
}

TEST(Precision, ADepthOffsetIsForCurvedSurfaces) {
  const double offsets[] = {0.125, 1, 8};
  const auto rows = depth_rows(offsets, 128);
  ASSERT_EQ(rows.size(), 9u);
  const DepthRow* const z16 = &rows[0];
  const DepthRow* const z24 = &rows[3];
  EXPECT_GT(z24[0].lost, z16[0].lost + 0.05);
  EXPECT_GT(z24[0].holes, 0);
  EXPECT_LT(0.5 * z24[0].holes, z24[0].lost) << "each has lost half";
  EXPECT_LT(z24[1].lost, 0.01);
  EXPECT_EQ(z24[1].leaks, 0);
  EXPECT_GT(z24[2].leaks, 0.9) << "further than the surface behind";
}

// Lines of docs/precision.md, made again for the first of its scenes.
TEST(Precision, TheDocumentationHolds) {
  const std::string page = text_of(SPLATSCOPE_SOURCE "/docs/precision.md");
  const std::vector<PrecisionScene> scenes{precision_plane(0, 128, 256)};
  const std::vector<Switch> switches{switch_of("nothing", ""), switch_of("texel bits", "8"),
                                     switch_of("sub-pixel bits", "4"), switch_of("frame", "10 bits")};
  for (const SwitchRow& row : switch_rows(switches, scenes)) {
    EXPECT_NE(page.find(line_of(row)), std::string::npos) << line_of(row);
  }
}

// 200 pixels that should be 0.5, and one beyond the surface. Right but for three: one a tenth off in red, one
// at 1 where 0.6 is wanted, a black one; and for white that is white as it should be.
TEST(Precision, ErrorsAreCountedOverTheSurface) {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  Frame frame(201, 1, formats);
  kernels::SplatSums reference;
  reference.width = 201;
  reference.height = 1;
  reference.sums.resize(201, glm::dvec4(1));
  reference.normalized.resize(201, glm::dvec3(0.5));
  for (Vec4& color : frame.colors32) color = {0.5f, 0.5f, 0.5f, 1};
  frame.colors32[3][0] = 0.6f;
  frame.colors32[50] = {1, 1, 1, 1};
  reference.normalized[50] = glm::dvec3(0.6);
  frame.colors32[99] = {0, 0, 0, 1};
  frame.colors32[120] = {1, 1, 1, 1};
  reference.normalized[120] = glm::dvec3(1);
  frame.colors32[200] = {0, 0, 0, 0};
  reference.sums[200] = glm::dvec4(0.4);  // less than half of the median
  const Errors errors = errors_of(frame, reference);
  EXPECT_NEAR(errors.psnr, -10 * std::log10((0.01 + 3 * 0.16 + 3 * 0.25) / 600), 1e-5);
  EXPECT_NEAR(errors.mean, 255 * (0.1 + 0.4 + 0.5) / 200, 1e-5);
  EXPECT_NEAR(errors.percentile99, 255 * 0.4, 1e-5) << "198 of 200 are less";
  EXPECT_NEAR(errors.bias, 255 * (0.1 + 3 * 0.4 - 3 * 0.5) / 600, 1e-5);
  EXPECT_EQ(errors.saturated, 1.0 / 200);
  EXPECT_EQ(errors.black, 1.0 / 200);
}

}  // namespace
}  // namespace splatscope::studies
