#include "studies/image_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "model/error.h"
#include "model/testing/scratch_folder.h"
#include "pictures/decoder.h"
#include "pictures/encode.h"
#include "studies/testing/read_image.h"

namespace splatscope::studies {
namespace {

namespace fs = std::filesystem;

class ImageFile : public ::testing::Test {
 protected:
  ScratchFolder folder_;
};

Image ramp() {
  Image image(5, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x)
      image.at(x, y) = {static_cast<float>(x) / 5, static_cast<float>(y) / 3, 1e-7f,
                        static_cast<float>(x * y) - 2};
  return image;
}

TEST_F(ImageFile, ExrKeepsEveryBit) {
  write_exr(ramp(), folder_ / "a.exr");
  const Image read = testing::read_image(folder_ / "a.exr");
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.pixels, ramp().pixels);
}

TEST_F(ImageFile, DepthIsOneChannel) {
  write_exr(GrayImage{2, 1, {0.25f, 1}}, folder_ / "depth.exr");
  const Image read = testing::read_image(folder_ / "depth.exr");
  EXPECT_EQ(read.at(0, 0), (std::array<float, 4>{0.25f, 0.25f, 0.25f, 1}));
  EXPECT_EQ(read.at(1, 0)[0], 1);
}

TEST_F(ImageFile, PngRoundsToEightBits) {
  Image image(256, 1);
  for (int x = 0; x < 256; ++x) {
    const float value = (static_cast<float>(x) + (x % 2 ? 0.4f : -0.4f)) / 255;
    image.at(x, 0) = {value, 1 - value, x < 128 ? -1.0f : 2.0f, 0.1f};
  }
  write_png(image, folder_ / "a.png");
  const Image read = testing::read_image(folder_ / "a.png");
  for (int x = 0; x < 256; ++x) {
    EXPECT_NEAR(read.at(x, 0)[0] * 255, x, 1e-4);
    EXPECT_NEAR(read.at(x, 0)[1] * 255, 255 - x, 1e-4);
    EXPECT_EQ(read.at(x, 0)[2], x < 128 ? 0 : 1) << "clamped";
    EXPECT_EQ(read.at(x, 0)[3], 1) << "alpha is not stored: it holds weights, not coverage";
  }
}

TEST_F(ImageFile, WhatIsNoNumberIsBlackInAPng) {
  Image image(2, 1);
  image.at(0, 0) = {std::nanf(""), INFINITY, -INFINITY, 1};
  image.at(1, 0) = {-0.0f, std::nanf(""), 1, 1};
  write_png(image, folder_ / "a.png");
  const Image read = testing::read_image(folder_ / "a.png");
  EXPECT_EQ(read.at(0, 0), (std::array<float, 4>{0, 1, 0, 1}));
  EXPECT_EQ(read.at(1, 0), (std::array<float, 4>{0, 0, 1, 1}));
}

TEST_F(ImageFile, FilesAppearWholeOrNotAtAll) {
  EXPECT_THROW(write_exr(ramp(), folder_ / "none" / "a.exr"), UserError);
  EXPECT_THROW(write_png(ramp(), folder_ / "none" / "a.png"), UserError);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

// Of PNG a gamma, as shown on a screen; of EXR the name of its channel, behind the size of the list of these.
TEST_F(ImageFile, SaysWhatItsNumbersAre) {
  write_png(ramp(), folder_ / "a.png");
  EXPECT_NE(text_of(folder_ / "a.png").find("sRGB"), std::string::npos);
  for (const char* channel : {"Z", "Y"}) {
    write_exr(GrayImage{2, 1, {0.25f, 1}}, folder_ / "a.exr", channel);
    const std::string bytes = text_of(folder_ / "a.exr"), list = "chlist";
    EXPECT_EQ(bytes.substr(bytes.find(list) + list.size() + 1 + 4, 1), channel);
  }
}

TEST_F(ImageFile, NothingLargerThanAskedForIsRead) {
  write_png(ramp(), folder_ / "a.png");
  const pictures::Source wide{(folder_ / "a.png").string()};
  std::string why;
  EXPECT_TRUE(pictures::decoder().read_bytes(wide, 3, 5, &why)) << why;
  EXPECT_FALSE(pictures::decoder().read_bytes(wide, 3, 4, &why));
  EXPECT_EQ(why, "of a size or depth that is not read");
  write_png(Image(2, 5), folder_ / "b.png");
  const pictures::Source high{(folder_ / "b.png").string()};
  EXPECT_TRUE(pictures::decoder().read_bytes(high, 3, 5, &why)) << why;
  EXPECT_FALSE(pictures::decoder().read_bytes(high, 3, 4, &why));
}

TEST_F(ImageFile, ThereIsNoneWhereItsMakingWasStopped) {
  const Image image = ramp();
  const pictures::Picture one{
      .width = 5, .height = 3, .channels = 3, .values = image.pixels[0].data(), .pixel_stride = 4};
  for (const auto encode : {pictures::encode_png, pictures::encode_exr}) {
    EXPECT_TRUE(encode(one, [] { return true; }).empty());
    EXPECT_FALSE(encode(one, [] { return false; }).empty());
    EXPECT_THROW(encode({.channels = 1}, [] { return false; }), std::runtime_error) << "of no pixel";
  }
}

TEST_F(ImageFile, HoldsNoDate) {
  write_exr(ramp(), folder_ / "a.exr");
  write_png(ramp(), folder_ / "a.png");
  for (const char* name : {"a.exr", "a.png"}) {
    const std::string bytes = text_of(folder_ / name);
    EXPECT_FALSE(std::regex_search(bytes, std::regex("[0-9]{4}:[0-9]{2}:[0-9]{2} "))) << name;
    EXPECT_EQ(bytes.find("tIME"), std::string::npos) << name;
  }
}

TEST_F(ImageFile, WhatIsNoPictureIsTheUsersError) {
  EXPECT_THROW(testing::read_image(folder_ / "none.exr"), UserError);
}

TEST(Psnr, KnownDistances) {
  const Image black(4, 4);
  Image gray = black;
  for (auto& pixel : gray.pixels) pixel = {0.1f, 0.1f, 0.1f, 55};
  EXPECT_NEAR(psnr(black, gray), 20, 1e-5) << "mean square error 0.01";
  EXPECT_EQ(psnr(gray, gray), INFINITY);
  std::vector<unsigned char> mask(16, 0);
  EXPECT_TRUE(std::isnan(psnr(black, gray, mask)));
  mask[3] = 1;
  gray.pixels[3] = {1, 1, 1, 0};
  EXPECT_EQ(psnr(black, gray, mask), 0) << "only the masked pixel counts";
  EXPECT_THROW(psnr(black, Image(3, 4)), ModelError);
}

}  // namespace
}  // namespace splatscope::studies
