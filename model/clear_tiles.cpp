#include "model/clear_tiles.h"

#include <algorithm>
#include <bit>

namespace splatscope {

ClearTiles::ClearTiles(const Frame& frame)
    : frame_(frame),
      across_(frame_tiles(frame.width)),
      clear_(std::size_t{across_} * frame_tiles(frame.height), 0) {}

bool ClearTiles::is_clear(std::uint32_t column, std::uint32_t row) const {
  const std::uint32_t left = column * kFrameTileEdge, right = std::min(left + kFrameTileEdge, frame_.width);
  const std::uint32_t top = row * kFrameTileEdge, bottom = std::min(top + kFrameTileEdge, frame_.height);
  for (std::uint32_t y = top; y < bottom; ++y) {
    const std::uint32_t* line = frame_.depth.data() + std::size_t{y} * frame_.width;
    for (std::uint32_t x = left; x < right; ++x)
      if (line[x] != frame_.cleared_depth) return false;
  }
  return true;
}

void ClearTiles::look(const raster::TriangleSetup& setup, int y) {
  for (const std::uint32_t tile : tiles_) clear_[tile] = 0;
  tiles_.clear();
  const auto tile_of = [](int pixel) { return static_cast<std::uint32_t>(pixel) / kFrameTileEdge; };
  const std::uint32_t last_row = tile_of(std::min(y + raster::kWindow, setup.bottom) - 1);
  const std::uint32_t last_column = tile_of(setup.right - 1);
  for (std::uint32_t row = tile_of(y); row <= last_row; ++row) {
    for (std::uint32_t column = tile_of(setup.left); column <= last_column; ++column) {
      if (!is_clear(column, row)) continue;
      tiles_.push_back(row * across_ + column);
      clear_[tiles_.back()] = 1;
    }
  }
}

void ClearTiles::note(std::span<const raster::Window> windows, std::uint32_t triangle,
                      std::vector<ClearTile>& out) {
  if (tiles_.empty()) return;  // nearly always
  for (const raster::Window& window : windows) {
    for (std::uint64_t rest = window.covered; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const auto x = static_cast<std::uint32_t>(window.x + raster::Window::x_of(bit)),
                 y = static_cast<std::uint32_t>(window.y + raster::Window::y_of(bit));
      const std::uint32_t tile = y / kFrameTileEdge * across_ + x / kFrameTileEdge;
      if (clear_[tile] == 0) continue;
      clear_[tile] = 0;
      out.push_back({triangle, tile});
    }
  }
}

}  // namespace splatscope
