#pragma once

#include <cstdint>

#include "model/command/commands.h"
#include "model/work/work.h"

namespace splatscope::texture {

struct Texel {
  float alpha = 0;          // 0..1
  std::uint32_t block = 0;  // kTexelBlockEdge^2 texels, numbered by rows of blocks
};

// The texel nearest to (u, v), texture coordinates in [0, 1] from the first texel's outer corner; clamped to
// the edge, NaN counts as 0.
inline Texel sample_nearest(const Texture& texture, float u, float v) {
  const auto texel = [](float coordinate, std::uint32_t size) {
    const float scaled = coordinate * static_cast<float>(size);
    if (!(scaled > 0)) return 0u;
    return scaled < static_cast<float>(size - 1) ? static_cast<std::uint32_t>(scaled) : size - 1;
  };
  const std::uint32_t x = texel(u, texture.width), y = texel(v, texture.height);
  const std::uint32_t blocks_in_row = (texture.width + kTexelBlockEdge - 1) / kTexelBlockEdge;
  return {static_cast<float>(texture.texels[y * std::size_t{texture.width} + x]) / 255.0f,
          (y / kTexelBlockEdge) * blocks_in_row + x / kTexelBlockEdge};
}

}  // namespace splatscope::texture
