#include "model/pixel/pixel_program.h"

#include <gtest/gtest.h>

#include <bit>
#include <memory>
#include <string>

#include "model/testing/simd_targets.h"

namespace splatscope::pixel {
namespace {

// r0 of a program with v0 = (.5, .25, 1, .75), t0 sampled as (0, 0, 0, .5), c0 = (1, -1, 3, .5).
Vec4 run(const std::string& text) {
  const PixelProgram program(isa::load(text, "test"));
  const auto batch = std::make_unique<FragmentBatch>();
  const Vec4 v0{0.5f, 0.25f, 1.0f, 0.75f};
  for (std::size_t c = 0; c < 4; ++c) batch->v0[c][kBatch - 1] = v0[c];
  batch->t[0][3][kBatch - 1] = 0.5f;
  const Vec4 c0{1, -1, 3, 0.5f};
  program.run({&c0, 1}, *batch, kBatch);
  const auto& r0 = batch->r0;
  return {r0[0][kBatch - 1], r0[1][kBatch - 1], r0[2][kBatch - 1], r0[3][kBatch - 1]};
}

TEST(PixelProgram, TexelAlphaTimesDiffuse) {
  EXPECT_EQ(run("ps_1_1\ntex t0\nmov r0.rgb, v0\n+ mul r0.a, v0, t0\n"), (Vec4{0.5f, 0.25f, 1.0f, 0.375f}));
  EXPECT_EQ(PixelProgram(isa::load("ps_1_1\ntex t0\nmov r0, t0.a\n", "test")).texture_stages(), 1u);
}

TEST(PixelProgram, LeavesItsInputsAsTheyAre) {
  const PixelProgram program(isa::load("ps_1_1\ntex t0\nmul t0, t0, v0\nmov r0, t0\n", "test"));
  const auto batch = std::make_unique<FragmentBatch>();
  for (std::size_t c = 0; c < 4; ++c) batch->v0[c][0] = batch->t[0][c][0] = 0.5f;
  program.run({}, *batch, 1);
  program.run({}, *batch, 1);
  EXPECT_EQ(0.25f, batch->r0[0][0]);
}

TEST(PixelProgram, RegistersKeepToTheirRange) {
  EXPECT_EQ(run("ps_1_1\nmov r0, c0\n"), (Vec4{1, -1, 1, 0.5f}));
  EXPECT_EQ(run("ps_1_1\nadd_x2 r0, v0, -c0\n"), (Vec4{-1, 1, 0, 0.5f}));
  EXPECT_EQ(run("ps_1_1\nadd_sat r0, v0, -c0\n"), (Vec4{0, 1, 0, 0.25f}));
}

// Of nine bits; also where a target's rounding says -0.
TEST(PixelProgram, StepsHaveOneZero) {
  const PixelProgram program(isa::load("ps_1_1\nmov r0, c0\n", "test"), CombinerFormat::signed9);
  const auto batch = std::make_unique<FragmentBatch>();
  const Vec4 c0{-0.001f, 0.001f, -0.0f, -0.003f};
  testing::on_each_simd_target([&] {
    program.run({&c0, 1}, *batch, kBatch);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(std::bit_cast<std::uint32_t>(batch->r0[c][0]), 0u) << c;
    EXPECT_EQ(batch->r0[3][0], -1 / 255.0f);
  });
}

TEST(PixelProgram, SourceAndDestinationModifiers) {
  EXPECT_EQ(run("ps_1_1\nmul_d2 r0, 1 - v0, v0_bx2.a\n"), (Vec4{0.125f, 0.1875f, 0, 0.0625f}));
  EXPECT_EQ(run("ps_1_1\nmov r0, -v0_bias\n"), (Vec4{0, 0.25f, -0.5f, -0.25f}));
}

TEST(PixelProgram, APairReadsBeforeEitherHalfWrites) {
  EXPECT_EQ(run("ps_1_1\nmov r0, v0\nmov r0.rgb, r0.a\n+ mov r0.a, r0.b\n"),
            (Vec4{0.75f, 0.75f, 0.75f, 1.0f}));
}

// Textures whose texel is (u, v, w, stage/8) at coordinates u v w, so a dependent read shows its coordinates.
struct Sampled {
  Vec4 r0{};
  bool killed = false;
  float depth = 0;
};

Sampled run_sampled(const std::string& text, const BumpStages& bump = {}) {
  const PixelProgram program(isa::load(text, "test"));
  const auto batch = std::make_unique<FragmentBatch>();
  const Vec4 coordinates[] = {
      {0.5f, 0.25f, 0.125f, 2}, {1, 0, 0.5f, 0.5f}, {0, 1, 0, 0.25f}, {0.5f, 0, 1, 0.125f}};
  for (std::size_t stage = 0; stage < 4; ++stage)
    for (std::size_t c = 0; c < 4; ++c) batch->t[stage][c][0] = coordinates[stage][c];
  const Vec4 v0{0.5f, 0.25f, 1.0f, 0.75f};
  for (std::size_t c = 0; c < 4; ++c) batch->v0[c][0] = v0[c];
  const Vec4 c0{0, 0, 1, 0};
  program.run(
      {&c0, 1}, *batch, 1,
      [](int stage, const Lanes* at, Lanes* texel, int) {
        for (std::size_t c = 0; c < 3; ++c) texel[c][0] = at[c][0];
        texel[3][0] = static_cast<float>(stage) / 8;
      },
      bump);
  const auto& r0 = batch->r0;
  return {{r0[0][0], r0[1][0], r0[2][0], r0[3][0]}, batch->killed == 1, batch->depth[0]};
}

TEST(PixelProgram, TextureRegistersAddressOtherTextures) {
  EXPECT_EQ(run_sampled("ps_1_1\ntex t1\ntexreg2ar t3, t1\nmov r0, t3\n").r0, (Vec4{0.125f, 1, 0, 0.375f}));
  EXPECT_EQ(run_sampled("ps_1_1\ntex t0\ntexreg2gb t3, t0\nmov r0, t3\n").r0,
            (Vec4{0.25f, 0.125f, 0, 0.375f}));
  EXPECT_EQ(run_sampled("ps_1_2\ntex t0\ntexreg2rgb t3, t0\nmov r0, t3\n").r0,
            (Vec4{0.5f, 0.25f, 0.125f, 0.375f}));
}

TEST(PixelProgram, MatrixRowsAddressTextures) {
  // t0 = (.5, .25, .125); rows: coordinates of t1, t2, t3.
  EXPECT_EQ(run_sampled("ps_1_1\ntex t0\ntexm3x2pad t1, t0\ntexm3x2tex t2, t0\nmov r0, t2\n").r0,
            (Vec4{0.5625f, 0.25f, 0, 0.25f}));
  const std::string rows = "ps_1_3\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\n";
  EXPECT_EQ(run_sampled(rows + "texm3x3tex t3, t0\nmov r0, t3\n").r0, (Vec4{0.5625f, 0.25f, 0.375f, 0.375f}));
  EXPECT_EQ(run_sampled(rows + "texm3x3 t3, t0\nmov r0, t3\n").r0, (Vec4{0.5625f, 0.25f, 0.375f, 1}));
  // N = (.5625, .25, .375), E = (0, 0, 1): 2 (N.E)/(N.N) N - E
  const float scale = 2 * 0.375f / (0.5625f * 0.5625f + 0.0625f + 0.140625f);
  const Vec4 reflected = run_sampled(rows + "texm3x3spec t3, t0, c0\nmov r0, t3\n").r0;
  EXPECT_FLOAT_EQ(reflected[0], scale * 0.5625f);
  EXPECT_FLOAT_EQ(reflected[2], scale * 0.375f - 1);
  EXPECT_EQ(run_sampled("ps_1_2\ntex t0\ntexdp3tex t3, t0\nmov r0, t3\n").r0, (Vec4{0.375f, 0, 0, 0.375f}));
  EXPECT_EQ(run_sampled("ps_1_2\ntex t0\ntexdp3 t3, t0\nmov r0, t3\n").r0,
            (Vec4{0.375f, 0.375f, 0.375f, 0.375f}));
}

TEST(PixelProgram, BumpMatricesMoveCoordinates) {
  BumpStages bump{};
  bump[1] = {{{0.5f, 0.25f}, {1.0f, 0.125f}}, 2.0f, 0.25f};
  // t1 + M (t0.r, t0.g) = (1 + .25 + .25, 0 + .125 + .03125)
  EXPECT_EQ(run_sampled("ps_1_1\ntex t0\ntexbem t1, t0\nmov_d2 r0, t1\n", bump).r0,
            (Vec4{0.75f, 0.078125f, 0, 0.0625f}));
  EXPECT_EQ(run_sampled("ps_1_1\ntex t0\ntexbeml t1, t0\nmov_d2 r0, t1\n", bump).r0,
            (Vec4{0.375f, 0.0390625f, 0, 0.03125f}));
  EXPECT_EQ(
      run_sampled("ps_1_4\ntexcrd r0.rgb, t1\ntexcrd r2.rgb, t0\nbem r1.rg, r0, r2\nphase\nmov r0, r1.g\n",
                  bump)
          .r0,
      (Vec4{0.15625f, 0.15625f, 0.15625f, 0.15625f}));
}

TEST(PixelProgram, CoordinatesOfPs14AreSelectedAndDivided) {
  EXPECT_EQ(run_sampled("ps_1_4\ntexld r0, t0_dw.xyw\nmov r0, r0\n").r0, (Vec4{0.25f, 0.125f, 0, 0}));
  EXPECT_EQ(run_sampled("ps_1_4\ntexld r2, t1.xyw\nmov r0, r2\n").r0, (Vec4{1, 0, 0.5f, 0.25f}));
  EXPECT_EQ(run_sampled("ps_1_4\ntexcrd r1.rgb, t0\nphase\ntexld r3, r1_dz\nmov r0, r3\n").r0,
            (Vec4{4, 2, 0, 0.375f}));
  // A divisor of 0 gives 1.
  EXPECT_EQ(run_sampled("ps_1_4\ntexcrd r1.rgb, t2\nphase\ntexld r3, r1_dz\nmov r0, r3\n").r0,
            (Vec4{1, 1, 0, 0.375f}));
}

TEST(PixelProgram, FragmentsAreKilledAndDepthReplaced) {
  EXPECT_FALSE(run_sampled("ps_1_1\ntexkill t0\nmov r0, v0\n").killed);
  EXPECT_TRUE(
      run_sampled("ps_1_4\ntexcrd r1.rgb, t0\nsub r1.rgb, r1, c0\nphase\ntexkill r1\nmov r0, v0\n").killed);
  EXPECT_EQ(run_sampled("ps_1_4\ntexcrd r5.rgb, t0\nphase\ntexdepth r5\nmov r0, v0\n").depth, 2.0f);
  EXPECT_EQ(run_sampled("ps_1_3\ntex t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov r0, v0\n").depth, 2.25f);
  EXPECT_EQ(run_sampled("ps_1_4\ntexcrd r5.rgb, t1\nphase\ntexdepth r5\nmov r0, v0\n").depth, 1.0f);
}

TEST(PixelProgram, OnlyWhatNeedsNoCoordinatesSamplesAhead) {
  const auto ahead = [](const std::string& text) {
    return PixelProgram(isa::load(text, "test")).samples_ahead();
  };
  EXPECT_TRUE(ahead("ps_1_1\ntex t0\ntexcoord t1\nmul r0, t0, t1\n"));
  EXPECT_TRUE(ahead("ps_1_4\ntexld r0, t0\nmov r0, r0\n"));
  EXPECT_TRUE(ahead("ps_1_4\ntexld r0, t0.xyz\nmov r0, r0\n"));
  EXPECT_FALSE(ahead("ps_1_4\ntexld r0, t0.xyw\nmov r0, r0\n"));
  EXPECT_FALSE(ahead("ps_1_4\ntexld r0, t0_dw.xyw\nmov r0, r0\n"));
  EXPECT_FALSE(ahead("ps_1_4\ntexld r0, t1\nmov r0, r0\n"));
  EXPECT_FALSE(ahead("ps_1_1\ntexkill t0\nmov r0, v0\n"));
  EXPECT_FALSE(ahead("ps_1_1\ntex t0\ntexbem t1, t0\nmov r0, t1\n"));
}

}  // namespace
}  // namespace splatscope::pixel
