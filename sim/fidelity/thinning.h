#pragma once

#include <cstdint>
#include <vector>

#include "sim/draw_jobs.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// A draw of which samples are left, one behind the other as if they were neighbours: so the pipeline runs on
// from each to the next, full and in its rhythm. Holds what the spans of its job() point to.
class ThinDraw {
 public:
  explicit ThinDraw(const DrawJob& whole);
  ThinDraw(ThinDraw&&) = default;

  // Keeps triangles [from, to) of the draw, from where the last call ended or after it, and marks where they
  // begin. They must be whole stretches (kStretch) but at the end of the draw.
  void keep(std::size_t from, std::size_t to);
  DrawJob job();

 private:
  struct Place {  // in the records of the draw
    std::size_t triangle = 0, vertex = 0, quad = 0, block = 0;
  };
  static Place find(const DrawWork& work, Place from, std::size_t triangle);

  DrawJob whole_;
  DrawWork work_;
  Place end_;  // of what was kept last
  std::vector<Cut> cuts_;
  std::vector<std::uint32_t> marks_;
};

}  // namespace splatscope::sim
