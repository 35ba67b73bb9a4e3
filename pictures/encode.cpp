#include "pictures/encode.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>

namespace splatscope::pictures {
namespace {

[[noreturn]] void fail(const char* why) {
  throw std::runtime_error(std::string("a picture could not be made: ") + why);
}

}  // namespace

std::vector<std::byte> encode_png(const Picture& picture, bool (*asked_to_stop)()) {
  constexpr std::array<png_uint_32, 4> kFormats{PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB,
                                                PNG_FORMAT_RGBA};
  std::vector<png_byte> bytes;
  bytes.reserve(picture.width * picture.height * picture.channels);
  for (std::size_t i = 0; i < picture.width * picture.height; ++i) {
    for (const float value : std::span(picture.values + i * picture.pixel_stride, picture.channels))
      bytes.push_back(static_cast<png_byte>((value > 0 ? std::min(value, 1.0f) : 0) * 255 + 0.5f));
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = kFormats.at(picture.channels - 1);
  image.flags = PNG_IMAGE_FLAG_FAST;  // a quarter of the time, and of splats no larger
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> file(size);
  if (asked_to_stop()) return {};
  if (png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr) == 0)
    fail(image.message);
  file.resize(size);
  return file;
}

std::vector<std::byte> encode_exr(const Picture& picture, bool (*asked_to_stop)()) try {
  constexpr int kRows = 16;  // that are compressed together
  const auto width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer values;
  for (std::size_t c = 0; c < picture.channels; ++c) {
    const std::string name = picture.channels == 1 ? picture.channel : std::string(1, "RGBA"[c]);
    const std::size_t pixel = picture.pixel_stride * sizeof(float);
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    values.insert(
        name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(picture.values + c)), pixel,
                         pixel * picture.width));  // only read
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(values);
    for (int y = 0; y < height; y += kRows) {
      if (asked_to_stop()) return {};
      file.writePixels(std::min(kRows, height - y));
    }
  }
  const std::string bytes = stream.str();
  const auto all = std::as_bytes(std::span(bytes));
  return {all.begin(), all.end()};
} catch (const Iex::BaseExc& error) {
  fail(error.what());
}

}  // namespace splatscope::pictures
