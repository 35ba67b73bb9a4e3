#include "model/texture/sample.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "model/testing/simd_targets.h"

namespace splatscope::texture {
namespace {

TEST(SampleNearest, TakesTheNearestTexelAndStaysAtTheEdge) {
  Texture texture{10, 6, std::vector<std::uint8_t>(60)};
  for (std::size_t i = 0; i < 60; ++i) texture.texels[i] = static_cast<std::uint8_t>(4 * i);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const std::array<float, 16> u{0, 0.099f, 0.1f, 0.95f, 1, 7, -3, kNan, kInf, -kInf, 0.45f};
  const std::array<float, 16> v{0, 0.01f, 0.2f, 0.99f, 1, 0.5f, 1e30f, 0.5f, kNan, 0.35f, 0.67f};
  const unsigned columns[] = {0, 0, 1, 9, 9, 9, 0, 0, 9, 0, 4}, rows[] = {0, 0, 1, 5, 5, 3, 5, 3, 0, 2, 4};
  testing::on_each_simd_target([&] {
    std::array<float, 11> alpha;
    std::array<std::uint32_t, 11> blocks;
    sample_nearest(texture, u.data(), v.data(), alpha, blocks);
    for (std::size_t i = 0; i < alpha.size(); ++i) {
      EXPECT_EQ(static_cast<float>(4 * (rows[i] * 10 + columns[i])) / 255.0f, alpha[i]) << i;
      EXPECT_EQ(rows[i] / 4 * 3 + columns[i] / 4, blocks[i]) << i;
    }
  });
}

TEST(SampleNearest, ReadsTexelsOfOtherDepths) {
  const std::array<float, 16> u{0.75f}, v{0.5f};
  std::array<float, 1> alpha;
  const Texture five{2, 1, {0, 20}, 5}, twelve{2, 1, {0, 0, 0x34, 0x0b}, 12};
  sample_nearest(five, u.data(), v.data(), alpha, {});
  EXPECT_EQ(20.0f / 31, alpha[0]);
  sample_nearest(twelve, u.data(), v.data(), alpha, {});
  EXPECT_EQ(0xb34 / 4095.0f, alpha[0]);
}

TEST(SampleSurface, TakesTheNearestPixelAndItsBlock) {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  Frame surface(10, 6, formats), bytes(10, 6, {});
  for (std::size_t i = 0; i < 60; ++i) {
    surface.colors32[i] = {static_cast<float>(i), 0.5f, -1, 2};
    bytes.colors8[i] = {static_cast<std::uint8_t>(i), 0, 51, 255};
  }
  // Pixel centres, and places beyond the edges. A tile is 4x4 pixels, three of them lie in a row.
  const std::array<float, 4> u{0.05f, 0.55f, 7, -1}, v{1 / 12.0f, 3 / 12.0f, 2, 5 / 12.0f};
  const unsigned columns[] = {0, 5, 9, 0}, rows[] = {0, 1, 5, 2};
  float color[4][4];
  const std::array<float*, 4> channels{color[0], color[1], color[2], color[3]};
  std::array<std::uint32_t, 4> blocks;
  sample_surface(surface, u.data(), v.data(), channels, blocks);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(color[0][i], static_cast<float>(rows[i] * 10 + columns[i]));
    EXPECT_EQ(color[2][i], -1);
    EXPECT_EQ(color[3][i], 2);
  }
  // 16 bytes a pixel: a block each. (5, 1) is pixel 3 of quad 0 of tile 1; (9, 5) pixel 3 of quad 0 of tile
  // 5; (0, 2) pixel 0 of quad 2.
  EXPECT_EQ(blocks, (std::array<std::uint32_t, 4>{0, 16 + 3, 5 * 16 + 3, 8}));
  sample_surface(bytes, u.data(), v.data(), channels, blocks);
  EXPECT_EQ(color[2][0], 0.2f);
  // 4 bytes a pixel: a quad is a block.
  EXPECT_EQ(blocks, (std::array<std::uint32_t, 4>{0, 4, 20, 2}));
}

TEST(SampleBilinear, WeighsTheFourTexelsAbout) {
  const Texture texture{2, 2, {0, 255, 255, 255}};
  const auto at = [&](float u, float v, int bits) {
    std::array<float, 1> alpha;
    sample_bilinear(texture, bits, &u, &v, alpha);
    return alpha[0];
  };
  EXPECT_EQ(at(0.25f, 0.25f, 8), 0);  // a texel's centre
  EXPECT_EQ(at(0, 0, 8), 0);          // clamped to the edge
  EXPECT_EQ(at(1, 0.1f, 8), 1);
  EXPECT_EQ(at(0.5f, 0.25f, 8), 0.5f);
  EXPECT_EQ(at(0.5f, 0.5f, 8), 0.75f);
  EXPECT_EQ(at(0.25f + 0.3f / 2, 0.25f, 1), 0.5f);  // 0.3 is nearer to 1/2 than to 0
  EXPECT_EQ(at(0.25f + 0.3f / 2, 0.25f, 2), 0.25f);
  EXPECT_EQ(at(std::numeric_limits<float>::quiet_NaN(), 0, 8), 0);
}

}  // namespace
}  // namespace splatscope::texture
