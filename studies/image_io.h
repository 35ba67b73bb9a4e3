#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

// Pictures as files, and how far two of them are apart.
namespace splatscope::studies {

// Rows from the top, pixel by pixel, r g b a each; 1 is white. Linear: no gamma is applied anywhere, as on
// the machines of 2002.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 4>> pixels;  // width * height

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::array<float, 4>& at(int x, int y) { return pixels[index(x, y)]; }
  const std::array<float, 4>& at(int x, int y) const { return pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// r g b of `pixels`, width * height in rows from the top; alpha 1.
Image opaque_image(int width, int height, std::span<const glm::dvec4> pixels);

// One channel, e.g. depth: 0 near, 1 far.
struct GrayImage {
  int width = 0;
  int height = 0;
  std::vector<float> pixels;
};

// Files appear whole or not at all. Throw UserError where the place cannot be written, std::runtime_error
// where the library fails.
void write_exr(const Image& image, const std::filesystem::path& path);  // binary32 RGBA
void write_exr(const GrayImage& image, const std::filesystem::path& path,
               const char* channel = "Z");                              // binary32; Z: depth
void write_png(const Image& image, const std::filesystem::path& path);  // 8-bit RGB: alpha holds no coverage

// Bytes of a PNG file.
std::vector<std::byte> encode_png(const Image& image);

// Peak signal-to-noise ratio against peak 1, in dB, of `values` whose differences have this sum of squares.
// Infinite where that is 0, NaN where there are none.
double decibels(double squares, std::size_t values);

// The same of r, g and b over the pixels where `mask` is not 0 (empty: all of them). The sizes must agree.
double psnr(const Image& a, const Image& b, const std::vector<unsigned char>& mask = {});

}  // namespace splatscope::studies
