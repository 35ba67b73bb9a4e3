#include "studies/image_io.h"

#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <span>

#include "model/error.h"
#include "model/stop.h"
#include "pictures/encode.h"
#include "traces/output_files.h"

namespace splatscope::studies {
namespace {

namespace fs = std::filesystem;

bool is_asked_to_stop() {
  return stop_signal != 0;
}

void write_exr(const pictures::Picture& picture, const fs::path& path) {
  const std::vector<std::byte> bytes = pictures::encode_exr(picture, is_asked_to_stop);
  stop_if_asked();
  traces::write_file(path, bytes);
}

pictures::Picture picture_of(const Image& image, std::size_t channels) {
  return {.width = static_cast<std::size_t>(image.width),
          .height = static_cast<std::size_t>(image.height),
          .channels = channels,
          .values = image.pixels.data()->data(),
          .pixel_stride = 4};
}

}  // namespace

Image opaque_image(int width, int height, std::span<const glm::dvec4> pixels) {
  Image image(width, height);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const glm::vec3 color(pixels[i]);
    image.pixels[i] = {color.r, color.g, color.b, 1};
  }
  return image;
}

void write_exr(const Image& image, const fs::path& path) {
  write_exr(picture_of(image, 4), path);
}

void write_exr(const GrayImage& image, const fs::path& path, const char* channel) {
  const pictures::Picture picture{.width = static_cast<std::size_t>(image.width),
                                  .height = static_cast<std::size_t>(image.height),
                                  .channels = 1,
                                  .channel = channel,
                                  .values = image.pixels.data(),
                                  .pixel_stride = 1};
  write_exr(picture, path);
}

void write_png(const Image& image, const fs::path& path) {
  traces::write_file(path, encode_png(image));
}

std::vector<std::byte> encode_png(const Image& image) {
  std::vector<std::byte> bytes = pictures::encode_png(picture_of(image, 3), is_asked_to_stop);
  stop_if_asked();
  return bytes;
}

double decibels(double squares, std::size_t values) {
  if (values == 0) return std::numeric_limits<double>::quiet_NaN();
  return -10 * std::log10(squares / static_cast<double>(values));
}

double psnr(const Image& a, const Image& b, const std::vector<unsigned char>& mask) {
  if (a.width != b.width || a.height != b.height || (!mask.empty() && mask.size() != a.pixels.size()))
    throw ModelError("psnr: the pictures differ in size");
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (!mask.empty() && !mask[i]) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double difference = double{a.pixels[i][channel]} - double{b.pixels[i][channel]};
      sum += difference * difference;
    }
    count += 3;
  }
  return decibels(sum, count);
}

}  // namespace splatscope::studies
