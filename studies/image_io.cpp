#include "studies/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <stdexcept>

#include "model/error.h"
#include "model/stop.h"
#include "traces/output_files.h"

namespace splatscope::studies {
namespace {

namespace fs = std::filesystem;

bool asked_to_stop(void*, float) {
  return stop_signal != 0;
}

// A whole file by the format's ending. In memory: the library does not notice where a disk is full.
std::vector<std::byte> encode(const std::string& ending, const OIIO::ImageSpec& spec, const void* pixels,
                              OIIO::stride_t pixel_stride) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput proxy(bytes);
  const std::string name = "picture" + ending;
  const auto out = OIIO::ImageOutput::create(name, &proxy);
  if (!out || !out->open(name, spec) ||
      !out->write_image(OIIO::TypeDesc::FLOAT, pixels, pixel_stride, OIIO::AutoStride, OIIO::AutoStride,
                        asked_to_stop) ||
      !out->close())
    throw std::runtime_error(
        fmt::format("a picture could not be made: {}", out ? out->geterror() : OIIO::geterror()));
  stop_if_asked();  // it calls a picture written that it was told to give up
  const auto all = std::as_bytes(std::span(bytes));
  return {all.begin(), all.end()};
}

OIIO::ImageSpec png_spec(const Image& image) {
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");  // shown as it is, like a frame buffer of 2002
  return spec;
}

// Without a date of its own the library writes that of today, and no two runs would give the same file.
OIIO::ImageSpec exr_spec(int width, int height, int channels) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  spec.attribute("DateTime", "");
  return spec;
}

constexpr OIIO::stride_t kPixelStride = sizeof(std::array<float, 4>);

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
  traces::write_file(
      path, encode(".exr", exr_spec(image.width, image.height, 4), image.pixels.data(), kPixelStride));
}

void write_exr(const GrayImage& image, const fs::path& path, const char* channel) {
  OIIO::ImageSpec spec = exr_spec(image.width, image.height, 1);
  spec.channelnames = {channel};
  if (spec.channelnames[0] == "Z") spec.z_channel = 0;
  traces::write_file(path, encode(".exr", spec, image.pixels.data(), sizeof(float)));
}

void write_png(const Image& image, const fs::path& path) {
  traces::write_file(path, encode_png(image));
}

std::vector<std::byte> encode_png(const Image& image) {
  return encode(".png", png_spec(image), image.pixels.data(), kPixelStride);
}

Image read_image(const fs::path& path) {
  const auto in = OIIO::ImageInput::open(path.string());
  if (!in) throw UserError(path.string(), 0, "cannot be read, expected a picture (EXR or PNG)");
  const OIIO::ImageSpec& spec = in->spec();
  Image image(spec.width, spec.height);
  const int channels = std::min(spec.nchannels, 4);
  for (auto& pixel : image.pixels) pixel = {0, 0, 0, 1};
  if (!in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, image.pixels.data(), kPixelStride))
    throw UserError(path.string(), 0, fmt::format("is damaged ({}), expected a picture", in->geterror()));
  if (channels < 3)
    for (auto& pixel : image.pixels) pixel[1] = pixel[2] = pixel[0];
  return image;
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
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return -10 * std::log10(sum / static_cast<double>(count));
}

}  // namespace splatscope::studies
