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

}  // namespace
}  // namespace splatscope::texture
