#include "traces/models/texture_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace splatscope::traces {
namespace {

std::optional<TextureImage> read(const std::string& name, OIIO::Filesystem::IOProxy* in_memory) {
  constexpr int kMost = 16384;  // texels
  const auto input = OIIO::ImageInput::open(name, nullptr, in_memory);
  if (!input) {
    OIIO::geterror();  // else OpenImageIO prints it at exit
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMost || spec.height > kMost || spec.depth > 1 ||
      spec.nchannels < 1)
    return std::nullopt;
  TextureImage image{static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height), {}};
  const int channels = std::min(spec.nchannels, 3);
  std::vector<std::uint8_t> bytes(image.width * image.height * static_cast<std::size_t>(channels));
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, bytes.data())) {
    input->geterror();
    return std::nullopt;
  }
  image.texels.resize(image.width * image.height * 3);
  const auto step = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < image.width * image.height; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      image.texels[3 * i + c] = bytes[step * i + (channels == 3 ? c : 0)];  // else grey
  return image;
}

}  // namespace

glm::vec3 TextureImage::at(const glm::vec2& texcoord) const {
  const auto wrap = [](double value, std::size_t size) {  // NaN and infinity: 0
    const double place = value - std::floor(value);
    return std::isfinite(place) ? place * static_cast<double>(size) - 0.5 : 0;
  };
  const double x = wrap(texcoord.x, width), y = wrap(1.0 - texcoord.y, height);
  const auto texel = [&](double column, double row) {
    const auto inside = [](double i, std::size_t size) {
      return static_cast<std::size_t>(i < 0 ? i + static_cast<double>(size) : i) % size;
    };
    const std::uint8_t* rgb = &texels[3 * (inside(row, height) * width + inside(column, width))];
    return glm::dvec3(rgb[0], rgb[1], rgb[2]) / 255.0;
  };
  const double left = std::floor(x), top = std::floor(y);
  const glm::dvec3 upper = glm::mix(texel(left, top), texel(left + 1, top), x - left);
  const glm::dvec3 lower = glm::mix(texel(left, top + 1), texel(left + 1, top + 1), x - left);
  return glm::vec3(glm::mix(upper, lower, y - top));
}

std::optional<TextureImage> read_texture(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  return read(path.string(), nullptr);
}

std::optional<TextureImage> read_texture(std::span<const std::byte> file, const std::string& ending) {
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());  // only read
  return read("embedded." + ending, &memory);
}

}  // namespace splatscope::traces
