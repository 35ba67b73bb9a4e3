#include "model/output/output.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "model/testing/random_seed.h"
#include "model/testing/simd_targets.h"

namespace splatscope::output {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

NumberFormats formats(FrameFormat frame, DepthFormat depth = DepthFormat::z24) {
  NumberFormats out;
  out.frame = frame;
  out.depth = depth;
  return out;
}

void write_one(const Vec4& color, std::uint32_t pixel, const DrawState& state, Frame& frame) {
  alignas(64) float colors[4][kLanes] = {};
  for (std::size_t c = 0; c < 4; ++c) colors[c][0] = color[c];
  write_colors({colors[0], colors[1], colors[2], colors[3]}, std::span(&pixel, 1), state, frame);
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

TEST(Output, BlendsAdditively) {
  DrawState state;
  state.blend = true;
  state.source_factor = BlendFactor::src_alpha;
  state.destination_factor = BlendFactor::one;
  Frame frame8(1, 1, formats(FrameFormat::unorm8)), frame32(1, 1, formats(FrameFormat::float32));
  for (int i = 0; i < 3; ++i) {
    write_one({1, 0.5f, 0, 0.25f}, 0, state, frame8);
    write_one({1, 0.5f, 0, 0.25f}, 0, state, frame32);
  }
  // 0.25 is 64/255, 0.5 is 128/255; 64*128/255 = 32.1; 64*64/255 = 16.06: the alpha channel sums the square.
  EXPECT_EQ((Color8{192, 96, 0, 48}), frame8.colors8[0]);
  EXPECT_EQ((Vec4{0.75f, 0.375f, 0, 0.1875f}), frame32.colors32[0]);
}

// Many fragments at once, some in the same pixel, are blended as the rule says, one after the other.
TEST(Output, EveryBlendFollowsTheRule) {
  std::mt19937 random(random_seed());
  constexpr std::size_t kCount = 80, kPixels = 7;
  const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
  const auto last = static_cast<unsigned>(BlendFactor::src_alpha_saturate);
  testing::on_each_simd_target([&] {
    for (unsigned factors = 0; factors < (last + 1) * (last + 1); ++factors) {
      DrawState state;
      state.blend = random() % 4 != 0;
      state.source_factor = BlendFactor(factors % (last + 1));
      state.destination_factor = random() % 2 ? BlendFactor::one : BlendFactor(factors / (last + 1));
      Frame frame(kPixels, 1, formats(FrameFormat::unorm8));
      for (Color8& color : frame.colors8) color = {byte(), byte(), byte(), byte()};
      std::vector<Color8> expected = frame.colors8;
      alignas(64) float colors[4][kCount];
      std::array<std::uint32_t, kCount> pixels;
      for (std::size_t i = 0; i < kCount; ++i) {
        const Color8 source{byte(), byte(), byte(), byte()};
        for (std::size_t c = 0; c < 4; ++c) colors[c][i] = static_cast<float>(source[c]) / 255;
        pixels[i] = static_cast<std::uint32_t>(random() % kPixels);
        Color8& pixel = expected[pixels[i]];
        const BlendState blend{state.source_factor, state.destination_factor, BlendEquation::add, {}};
        pixel = state.blend ? blend_unorm8(blend, source, pixel) : source;
      }
      write_colors({colors[0], colors[1], colors[2], colors[3]}, pixels, state, frame);
      ASSERT_EQ(expected, frame.colors8) << factors;
    }
  });
}

// Of all products of 8-bit numbers.
TEST(Output, AdditiveBlendingRoundsEveryProduct) {
  DrawState state;
  state.blend = true;
  state.source_factor = BlendFactor::src_alpha;
  state.destination_factor = BlendFactor::one;
  Frame frame(1, 1, formats(FrameFormat::unorm8));
  for (int s = 0; s < 256; ++s) {
    for (int a = 0; a < 256; ++a) {
      const Color8 source{static_cast<std::uint8_t>(s), 255, 0, static_cast<std::uint8_t>(a)};
      frame.colors8[0] = {0, 0, 0, 0};
      write_one({static_cast<float>(s) / 255, 1, 0, static_cast<float>(a) / 255}, 0, state, frame);
      const BlendState blend{BlendFactor::src_alpha, BlendFactor::one, BlendEquation::add, {}};
      ASSERT_EQ(blend_unorm8(blend, source, {}), frame.colors8[0]) << s << ' ' << a;
    }
  }
}

TEST(Output, ReceivesColors) {
  testing::on_each_simd_target([] {
    const std::array<float, kLanes> given{-1, 0, 0.001f, 0.5f, 1, 2, kNaN};
    std::array<float, kLanes> eight_bits = given, floats = given, twelve_bits = given;
    receive_colors(eight_bits.data(), given.size(), ColorFormat::unorm8);
    receive_colors(twelve_bits.data(), given.size(), ColorFormat::unorm12);
    receive_colors(floats.data(), given.size(), ColorFormat::float32);
    for (std::size_t i = 0; i < given.size(); ++i) {
      EXPECT_EQ(static_cast<float>(quantize_unorm8(given[i])) / 255.0f, eight_bits[i]) << given[i];
      EXPECT_EQ(saturate(given[i]), floats[i]) << given[i];
      EXPECT_NEAR(saturate(given[i]), twelve_bits[i], 0.5 / 4095 + 0x1p-25) << given[i];
      EXPECT_EQ(std::round(4095 * twelve_bits[i]) / 4095, twelve_bits[i]) << given[i];
    }
  });
}

TEST(Output, ReceivesEachColorOfEightBitsAsItIs) {
  std::array<float, 256> given;
  for (int n = 0; n < 256; ++n) given[static_cast<std::size_t>(n)] = static_cast<float>(n) / 255.0f;
  testing::on_each_simd_target([&] {
    std::array<float, 256> received = given;
    receive_colors(received.data(), received.size(), ColorFormat::unorm8);
    EXPECT_EQ(received, given);
  });
}

TEST(Output, SaturatesInEightBits) {
  DrawState state;
  state.blend = true;
  state.destination_factor = BlendFactor::one;
  Frame frame(1, 1, formats(FrameFormat::unorm8));
  for (int i = 0; i < 3; ++i) write_one({0.4f, 0, 0, 0.4f}, 0, state, frame);
  EXPECT_EQ((Color8{255, 0, 0, 255}), frame.colors8[0]);
}

// -0.5 over 0.5, and 4 times 0.5 of the destination: a colour counts as 0 to 1, but in formats that go
// beyond.
TEST(Output, FixedPointFramesClampAColorBeforeItsFactors) {
  DrawState adds, scales;
  adds.blend = scales.blend = true;
  adds.source_factor = adds.destination_factor = BlendFactor::one;
  scales.source_factor = BlendFactor::dst_color;
  scales.destination_factor = BlendFactor::zero;
  for (const FrameFormat format : {FrameFormat::unorm8, FrameFormat::unorm10, FrameFormat::unorm16,
                                   FrameFormat::half, FrameFormat::float32}) {
    const bool clamps = format != FrameFormat::half && format != FrameFormat::float32;
    for (const FrameRounding rounding :
         {FrameRounding::nearest, FrameRounding::truncate, FrameRounding::dither}) {
      NumberFormats numbers = formats(format);
      numbers.frame_rounding = rounding;
      const auto over_half = [&](float color, const DrawState& state) {
        Frame frame(1, 1, numbers);
        clear({{0.5f, 0.5f, 0.5f, 0.5f}, 1}, frame);
        write_one({color, 0, 0, 0}, 0, state, frame);
        return frame.color(0)[0];
      };
      EXPECT_NEAR(over_half(-0.5f, adds), clamps ? 0.5 : 0, 1.0 / 255);
      EXPECT_NEAR(over_half(4, scales), clamps ? 0.5 : 2, 1.0 / 255);
    }
  }
}

// 16 splats of 0.7/255 each on a tile of 4x4 pixels: what each frame format makes of their sum.
TEST(Output, FrameFormatsRoundSmallSums) {
  DrawState state;
  state.blend = true;
  state.source_factor = BlendFactor::src_alpha;
  state.destination_factor = BlendFactor::one;
  const auto mean = [&](FrameFormat format, FrameRounding rounding) {
    NumberFormats numbers = formats(format);
    numbers.frame_rounding = rounding;
    Frame frame(4, 4, numbers);
    double sum = 0;
    for (std::uint32_t pixel = 0; pixel < 16; ++pixel) {
      for (int i = 0; i < 16; ++i) write_one({7.0f / 255, 0, 0, 26.0f / 255}, pixel, state, frame);
      sum += 255 * static_cast<double>(frame.color(pixel)[0]);
    }
    return sum / 16;
  };
  const double exact = 16 * 7 * 26 / 255.0;
  EXPECT_DOUBLE_EQ(mean(FrameFormat::unorm8, FrameRounding::truncate), 0);
  EXPECT_NEAR(mean(FrameFormat::unorm8, FrameRounding::nearest), 16, 1e-5);
  // half a step of the pattern's 16, and the slack of stored_value
  EXPECT_NEAR(mean(FrameFormat::unorm8, FrameRounding::dither), exact, 16 * (1.0 / 32 + 1.0 / 128));
  EXPECT_NEAR(mean(FrameFormat::unorm10, FrameRounding::nearest), exact, 16 * 0.5 / 4);
  EXPECT_LT(mean(FrameFormat::unorm16, FrameRounding::truncate), exact);
  EXPECT_NEAR(mean(FrameFormat::unorm16, FrameRounding::truncate), exact, 16.0 / 257);
  EXPECT_NEAR(mean(FrameFormat::half, FrameRounding::nearest), exact, 16 * exact / 4096);
  EXPECT_NEAR(mean(FrameFormat::float32, FrameRounding::nearest), exact, 1e-5);
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
