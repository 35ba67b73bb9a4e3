#include "traces/models/texture_image.h"

#include <cmath>
#include <glm/common.hpp>

#include "pictures/decoder.h"

namespace splatscope::traces {
namespace {

std::optional<TextureImage> read(const pictures::Source& source) {
  constexpr std::size_t kMost = 16384;  // texels
  std::string why;
  const auto decoded = pictures::decoder().read_bytes(source, 3, kMost, &why);
  if (!decoded) return std::nullopt;
  TextureImage image{decoded->width, decoded->height, {}};
  image.texels.resize(image.width * image.height * 3);
  for (std::size_t i = 0; i < image.width * image.height; ++i)
    for (std::size_t c = 0; c < 3; ++c)  // else grey
      image.texels[3 * i + c] = decoded->values[decoded->channels * i + (decoded->channels == 3 ? c : 0)];
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
  return read({path.string()});
}

std::optional<TextureImage> read_texture(std::span<const std::byte> file, const std::string& ending) {
  return read({"embedded." + ending, file});
}

}  // namespace splatscope::traces
