#include "traces/models/texture_image.h"

#include <gtest/gtest.h>

#include <array>

#include "pictures/encode.h"

namespace splatscope::traces {
namespace {

// Black and white, side by side: on the edges of the picture and in its middle they meet half and half.
TEST(TextureImage, RepeatsInBothDirections) {
  const TextureImage across{2, 1, {0, 0, 0, 255, 255, 255}}, down{1, 2, {255, 255, 255, 0, 0, 0}};
  for (const float at : {-1.0f, -0.5f, 0.0f, 0.5f, 1.0f, 1.5f}) {
    EXPECT_FLOAT_EQ(across.at({at, 0.3f}).r, 0.5f) << at;
    EXPECT_FLOAT_EQ(down.at({0.3f, at}).r, 0.5f) << at;
  }
  EXPECT_FLOAT_EQ(across.at({0.25f, 0}).r, 0);
  EXPECT_FLOAT_EQ(across.at({0.75f, 0}).r, 1);
  EXPECT_FLOAT_EQ(down.at({0, 0.25f}).r, 0) << "v runs up, and rows down";
  EXPECT_FLOAT_EQ(down.at({0, 0.75f}).r, 1);
}

// The second channel is no green.
TEST(TextureImage, GreyWithAlphaIsGrey) {
  const std::array<float, 2> pixel{0.2f, 1};
  const auto file = pictures::encode_png(
      {.width = 1, .height = 1, .channels = 2, .values = pixel.data(), .pixel_stride = 2},
      [] { return false; });
  const auto image = read_texture(file, "png");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->texels, (std::vector<std::uint8_t>{51, 51, 51}));
}

}  // namespace
}  // namespace splatscope::traces
