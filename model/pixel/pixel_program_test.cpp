#include "model/pixel/pixel_program.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

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

TEST(PixelProgram, RegistersKeepToTheirRange) {
  EXPECT_EQ(run("ps_1_1\nmov r0, c0\n"), (Vec4{1, -1, 1, 0.5f}));
  EXPECT_EQ(run("ps_1_1\nadd_x2 r0, v0, -c0\n"), (Vec4{-1, 1, 0, 0.5f}));
  EXPECT_EQ(run("ps_1_1\nadd_sat r0, v0, -c0\n"), (Vec4{0, 1, 0, 0.25f}));
}

TEST(PixelProgram, SourceAndDestinationModifiers) {
  EXPECT_EQ(run("ps_1_1\nmul_d2 r0, 1 - v0, v0_bx2.a\n"), (Vec4{0.125f, 0.1875f, 0, 0.0625f}));
  EXPECT_EQ(run("ps_1_1\nmov r0, -v0_bias\n"), (Vec4{0, 0.25f, -0.5f, -0.25f}));
}

TEST(PixelProgram, APairReadsBeforeEitherHalfWrites) {
  EXPECT_EQ(run("ps_1_1\nmov r0, v0\nmov r0.rgb, r0.a\n+ mov r0.a, r0.b\n"),
            (Vec4{0.75f, 0.75f, 0.75f, 1.0f}));
}

}  // namespace
}  // namespace splatscope::pixel
