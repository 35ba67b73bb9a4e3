#include "kernels/object_space_ewa/alpha_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace splatscope::kernels {
namespace {

int texel(const Texture& texture, int column, int row) {
  return texture.texels[static_cast<std::size_t>(row) * texture.width + static_cast<std::size_t>(column)];
}

int largest_step(const Texture& texture) {
  int largest = 0;
  for (int row = 0; row < static_cast<int>(texture.height); ++row) {
    for (int column = 1; column < static_cast<int>(texture.width); ++column) {
      largest = std::max(largest, std::abs(texel(texture, column, row) - texel(texture, column - 1, row)));
    }
  }
  return largest;
}

TEST(AlphaTexture, LengthOfThePaper) {
  EXPECT_EQ(optimal_length(1.0), 438);
}

TEST(AlphaTexture, LengthIsTheSmallestThatSatisfiesEquation15) {
  for (const double cutoff : {0.1, 0.3, 0.5, 0.7, 1.0, 2.0, 4.0}) {
    const double radius = std::sqrt(2.0 * cutoff);
    double steepest = 0;
    for (int i = 0; i <= 100000; ++i) {
      const double r = radius * i / 100000;
      steepest = std::max(steepest, r * std::exp(-0.5 * r * r));
    }
    const int length = optimal_length(cutoff);
    EXPECT_LE(steepest * radius / (0.5 * length), 1.0 / 255.0) << "c = " << cutoff;
    EXPECT_GT(steepest * radius / (0.5 * (length - 1)), 1.0 / 255.0) << "c = " << cutoff;
  }
}

TEST(AlphaTexture, OptimalLengthLeavesNoStepOut) {
  EXPECT_EQ(largest_step(alpha_texture(1.0, 438, CutoffShape::square)), 1);
  EXPECT_EQ(largest_step(alpha_texture(1.0, 219, CutoffShape::square)), 2);
}

TEST(AlphaTexture, TexelsAreTheGaussianAtTheirCentres) {
  // len = 4, c = 2: centres at y = -1.5, -0.5, 0.5, 1.5.
  const Texture texture = alpha_texture(2.0, 4, CutoffShape::square);
  EXPECT_EQ(texture.width, 4u);
  EXPECT_EQ(texture.height, 4u);
  ASSERT_EQ(texture.texels.size(), 16u);
  EXPECT_EQ(texel(texture, 1, 2), 199);  // 255 exp(-0.25)
  EXPECT_EQ(texel(texture, 0, 1), 73);   // 255 exp(-1.25)
  EXPECT_EQ(texel(texture, 1, 0), 73);
  EXPECT_EQ(texel(texture, 3, 3), 27);  // 255 exp(-2.25)
}

TEST(AlphaTexture, CircleIsTheSquareWithItsCornersCut) {
  const int length = 101;
  const Texture square = alpha_texture(1.0, length, CutoffShape::square);
  const Texture circle = alpha_texture(1.0, length, CutoffShape::circle);
  for (int row = 0; row < length; ++row) {
    for (int column = 0; column < length; ++column) {
      const bool inside = std::hypot(column - 50, row - 50) <= 50.5;
      EXPECT_EQ(texel(circle, column, row), inside ? texel(square, column, row) : 0);
    }
  }
}

}  // namespace
}  // namespace splatscope::kernels
