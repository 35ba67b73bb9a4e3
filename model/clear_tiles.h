#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/output/frame.h"
#include "model/raster/raster.h"
#include "model/work/work.h"

namespace splatscope {

// Which tiles of a frame hold the depth of the last clear in all their pixels, for one band of a triangle at
// a time. One in which that very depth was written is among them.
class ClearTiles {
 public:
  explicit ClearTiles(const Frame& frame);  // outlives it

  // Before the band of 8 rows at `y` is rasterised.
  void look(const raster::TriangleSetup& setup, int y);
  // Behind it: appends to `out` those of the tiles in which its windows cover pixels.
  void note(std::span<const raster::Window> windows, std::uint32_t triangle, std::vector<ClearTile>& out);

 private:
  bool is_clear(std::uint32_t column, std::uint32_t row) const;

  const Frame& frame_;
  std::uint32_t across_;
  std::vector<std::uint8_t> clear_;   // 1 for the tiles of the band that are
  std::vector<std::uint32_t> tiles_;  // the same as a list
};

}  // namespace splatscope
