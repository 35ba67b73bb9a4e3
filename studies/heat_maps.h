#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/command/commands.h"
#include "model/work/work.h"
#include "sim/observe/tile_cycles.h"
#include "studies/image_io.h"

// Where in the frame the work of a run was, over all of its draws and frames.
namespace splatscope::studies {

struct HeatMap {
  std::string name;  // "overdraw"; of its file without ending
  std::string unit;
  std::string what;
  std::string counter;    // of results.json, that its sum is equal to
  int scale = 1;          // pixels of the frame across a pixel of the map
  GrayImage image;        // counts
  std::uint64_t sum = 0;  // over the map
};

class HeatMaps {
 public:
  // `cycles`: whether the run is simulated, and so knows what a tile takes. `trace` outlives this.
  HeatMaps(const Trace& trace, bool cycles);

  // Of each draw, or of each of its parts.
  void add(const DrawWork& work);
  // To watch the run; null without `cycles`.
  sim::Observer* observer() { return tiles_ ? &*tiles_ : nullptr; }

  // After the run: overdraw, depth fails, texel fetches, cycles a tile.
  std::vector<HeatMap> maps() const;

 private:
  const Trace& trace_;
  HeatMap overdraw_, depth_fails_, texel_fetches_;
  std::optional<sim::TileCycles> tiles_;
};

// In colours, from 0 (black) over purple and orange to the largest count (pale yellow), by the logarithm of
// 1 + count; magnified to the frame's pixels.
Image colored(const HeatMap& map);

}  // namespace splatscope::studies
