#include <algorithm>

#include "model/number/frame_value.h"
#include "model/texture/sample.h"

namespace splatscope::texture {
namespace {

std::uint32_t nearest(float coordinate, std::uint32_t size) {
  const float place = coordinate * static_cast<float>(size);
  return place > 0 ? static_cast<std::uint32_t>(std::min(place, static_cast<float>(size - 1))) : 0;
}

// The 16-byte block that a pixel lies in.
std::uint32_t block_of(std::uint32_t x, std::uint32_t y, std::uint32_t tiles_across, std::uint32_t bytes) {
  const std::uint32_t tile = y / 4 * tiles_across + x / 4;
  const std::uint32_t quad = (y / 2 % 2) * 2 + x / 2 % 2, in_quad = y % 2 * 2 + x % 2;
  return tile * bytes + (quad * 4 + in_quad) * bytes / 16;
}

}  // namespace

void sample_surface(const Frame& surface, const float* u, const float* v, const std::array<float*, 4>& color,
                    std::span<std::uint32_t> blocks) {
  const std::uint32_t bytes = bytes_per_pixel(surface.formats.frame);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::uint32_t x = nearest(u[i], surface.width), y = nearest(v[i], surface.height);
    const Vec4 value = surface.color(std::size_t{y} * surface.width + x);
    for (std::size_t c = 0; c < 4; ++c) color[c][i] = value[c];
    blocks[i] = block_of(x, y, (surface.width + 3) / 4, bytes);
  }
}

}  // namespace splatscope::texture
