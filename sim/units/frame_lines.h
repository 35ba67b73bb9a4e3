#pragma once

#include <cstdint>

#include "model/work/work.h"

namespace splatscope::sim {

// A surface of the frame as memory holds it: rows of tiles (kFrameTileEdge), one cache line each.
struct FrameLines {
  std::uint32_t tiles_across = 0;
  std::uint32_t tiles_down = 0;
  std::uint32_t bytes_per_pixel = 4;

  static FrameLines of(std::uint32_t width, std::uint32_t height, std::uint32_t bytes_per_pixel) {
    return {frame_tiles(width), frame_tiles(height), bytes_per_pixel};
  }
  std::uint32_t line_of(const QuadWork& quad) const { return quad.y / 2u * tiles_across + quad.x / 2u; }
  std::uint32_t line_bytes() const { return kFrameTileEdge * kFrameTileEdge * bytes_per_pixel; }
  std::uint32_t lines() const { return tiles_across * tiles_down; }
  std::uint32_t bytes() const { return lines() * line_bytes(); }
};

}  // namespace splatscope::sim
