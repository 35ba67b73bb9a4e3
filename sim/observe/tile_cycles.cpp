#include "sim/observe/tile_cycles.h"

#include <utility>

#include "sim/machine.h"
#include "sim/units/raster/rasteriser.h"

namespace splatscope::sim {

TileCycles::TileCycles(std::uint32_t width, std::uint32_t height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      cycles_(std::size_t{columns_} * rows_) {}

void TileCycles::begin(const SimulatedMachine& machine) {
  for (const auto& unit : machine.units) {
    auto* raster = dynamic_cast<Rasteriser*>(unit.get());
    if (!raster) continue;
    raster_ = raster;
    raster->on_quad([this](Cycle now, const QuadWork& quad) {
      tile_ = std::size_t{quad.y * 2 / kTile} * columns_ + quad.x * 2 / kTile;
      cycles_[tile_] += std::exchange(before_, 0);
      count(now + 1);
    });
  }
}

void TileCycles::count(Cycle until) {
  if (until <= since_) return;
  (tile_ == kNone ? before_ : cycles_[tile_]) += until - since_;
  since_ = until;
}

void TileCycles::booked(const Unit& unit, std::uint32_t book, Cycle from, Cycle until) {
  if (&unit != raster_ || book != Step::kIdle) return;
  count(from);  // what followed the draw's last quad
  since_ = until;
}

void TileCycles::end(const Result& result) {
  count(result.cycles);
}

}  // namespace splatscope::sim
