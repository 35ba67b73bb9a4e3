#include "model/output/output.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace splatscope::output {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

NumberFormats formats(FrameFormat frame, DepthFormat depth = DepthFormat::z24) {
  NumberFormats out;
  out.frame = frame;
  out.depth = depth;
  return out;
}

TEST(Output, QuantizesDepth) {
  EXPECT_EQ(0u, quantize_depth(0, DepthFormat::z24));
  EXPECT_EQ(0xffffffu, quantize_depth(1, DepthFormat::z24));
  EXPECT_EQ(0xffffu, quantize_depth(7, DepthFormat::z16));
  EXPECT_EQ(0u, quantize_depth(-1, DepthFormat::z24));
  EXPECT_EQ(0u, quantize_depth(kNaN, DepthFormat::float32));
  EXPECT_EQ(8388608u, quantize_depth(0.5f, DepthFormat::z24));
  EXPECT_LT(quantize_depth(0.25f, DepthFormat::float32), quantize_depth(0.2500001f, DepthFormat::float32));
}

TEST(Output, QuantizesColorToNearest) {
  EXPECT_EQ(0, quantize_unorm8(0.49f / 255));
  EXPECT_EQ(1, quantize_unorm8(0.51f / 255));
  EXPECT_EQ(255, quantize_unorm8(3));
  EXPECT_EQ(0, quantize_unorm8(-3));
  EXPECT_EQ(0, quantize_unorm8(kNaN));
}

TEST(Output, DepthTestKeepsTheNearest) {
  Frame frame(2, 1, formats(FrameFormat::unorm8));
  clear(Clear{}, frame);
  DrawState state;
  EXPECT_TRUE(test_depth(500, 0, state, frame));
  EXPECT_FALSE(test_depth(501, 0, state, frame));
  EXPECT_TRUE(test_depth(500, 0, state, frame));  // less or equal
  state.depth_write = false;
  EXPECT_TRUE(test_depth(100, 0, state, frame));
  EXPECT_EQ(500u, frame.depth[0]);
  EXPECT_EQ(0xffffffu, frame.depth[1]);
}

TEST(Output, BlendsAdditively) {
  DrawState state;
  state.blend = true;
  state.source_factor = BlendFactor::src_alpha;
  state.destination_factor = BlendFactor::one;
  Frame frame8(1, 1, formats(FrameFormat::unorm8)), frame32(1, 1, formats(FrameFormat::float32));
  for (int i = 0; i < 3; ++i) {
    write_color({1, 0.5f, 0, 0.25f}, 0, state, frame8);
    write_color({1, 0.5f, 0, 0.25f}, 0, state, frame32);
  }
  // 0.25 is 64/255, 0.5 is 128/255; 64*128/255 = 32.1; 64*64/255 = 16.06: the alpha channel sums the square.
  EXPECT_EQ((Color8{192, 96, 0, 48}), frame8.colors8[0]);
  EXPECT_EQ((Vec4{0.75f, 0.375f, 0, 0.1875f}), frame32.colors32[0]);
}

// The short way for the blending of splats gives what the rule gives.
TEST(Output, AdditiveBlendingFollowsTheRule) {
  Frame frame(1, 1, formats(FrameFormat::unorm8));
  for (const BlendFactor factor : {BlendFactor::one, BlendFactor::src_alpha}) {
    DrawState state;
    state.blend = true;
    state.source_factor = factor;
    state.destination_factor = BlendFactor::one;
    for (int s = 0; s < 256; ++s) {
      for (int a = 0; a < 256; a += 3) {
        const Color8 source{static_cast<std::uint8_t>(s), 255, 0, static_cast<std::uint8_t>(a)};
        const Color8 destination{static_cast<std::uint8_t>(255 - a), static_cast<std::uint8_t>(a), 77, 200};
        frame.colors8[0] = destination;
        write_color({static_cast<float>(s) / 255, 1, 0, static_cast<float>(a) / 255}, 0, state, frame);
        ASSERT_EQ(blend_unorm8({factor, BlendFactor::one, BlendEquation::add, {}}, source, destination),
                  frame.colors8[0])
            << s << ' ' << a;
      }
    }
  }
}

TEST(Output, SaturatesInEightBits) {
  DrawState state;
  state.blend = true;
  state.destination_factor = BlendFactor::one;
  Frame frame(1, 1, formats(FrameFormat::unorm8));
  for (int i = 0; i < 3; ++i) write_color({0.4f, 0, 0, 0.4f}, 0, state, frame);
  EXPECT_EQ((Color8{255, 0, 0, 255}), frame.colors8[0]);
}

TEST(Output, NormalizesBySummedWeights) {
  Frame frame(2, 1, formats(FrameFormat::unorm8));
  frame.colors8 = {{100, 50, 0, 200}, {7, 0, 0, 0}};
  normalize(frame);
  EXPECT_EQ((Color8{128, 64, 0, 255}), frame.colors8[0]);  // 127.5 and 63.75, to nearest
  EXPECT_EQ((Color8{7, 0, 0, 0}), frame.colors8[1]);

  Frame floats(1, 1, formats(FrameFormat::float32));
  floats.colors32 = {{0.25f, 0.5f, 0, 0.5f}};
  normalize(floats);
  EXPECT_EQ((Vec4{0.5f, 1, 0, 1}), floats.colors32[0]);
}

}  // namespace
}  // namespace splatscope::output
