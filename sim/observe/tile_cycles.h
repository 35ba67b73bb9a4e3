#pragma once

#include <vector>

#include "sim/kernel/observer.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// How long the rasteriser was at each 8x8-pixel tile of the frame: the cycles in which it was busy, starved
// or blocked since the quad before, whatever tile that was in, count for a quad's tile; those after a draw's
// last quad for the tile of that. Summed over all draws these are all the cycles in which it was not idle,
// unless there is no quad at all. Where the rasteriser waits because what is behind it is full, they
// tell what a tile cost from there on; where it is starved, what its triangles cost before.
class TileCycles final : public Observer {
 public:
  static constexpr std::uint32_t kTile = 8;  // pixels

  // Of frames of `width` x `height` pixels.
  TileCycles(std::uint32_t width, std::uint32_t height);

  void begin(const SimulatedMachine& machine) override;
  void booked(const Unit& unit, std::uint32_t book, Cycle from, Cycle until) override;
  Cycle sample(Cycle) override { return kNever; }
  void end(const Result& result) override;

  std::uint32_t columns() const { return columns_; }
  std::uint32_t rows() const { return rows_; }
  const std::vector<Cycle>& cycles() const { return cycles_; }  // of each tile, by rows from the top

 private:
  void count(Cycle until);

  std::uint32_t columns_, rows_;
  std::vector<Cycle> cycles_;
  const Unit* raster_ = nullptr;
  std::size_t tile_ = kNone;  // of the last quad
  Cycle since_ = 0;           // all before it is counted or was idle
  Cycle before_ = 0;          // of draws that came before the first quad
  static constexpr std::size_t kNone = ~std::size_t{0};
};

}  // namespace splatscope::sim
