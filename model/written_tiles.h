#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/raster/raster.h"
#include "model/work/work.h"

namespace splatscope {

// The tiles of a frame in which a draw has written depth.
class WrittenTiles {
 public:
  WrittenTiles(std::uint32_t width, std::uint32_t height);  // of the frame, pixels

  // Appends to `out` what the windows of a triangle wrote (all that passed) where nothing was written before.
  void note(std::span<const raster::Window> windows, std::uint32_t triangle, std::vector<TileWritten>& out);

 private:
  std::uint32_t across_;
  std::vector<std::uint8_t> written_;  // 1 where written
};

}  // namespace splatscope
