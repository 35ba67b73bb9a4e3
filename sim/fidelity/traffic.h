#pragma once

#include <cstdint>
#include <vector>

#include "model/machine/machine.h"
#include "sim/draw_jobs.h"

namespace splatscope::sim {

// Bytes to and from video memory for a quad of a draw, on average.
struct Traffic {
  double depth = 0;    // of every quad
  double color = 0;    // of a quad that goes on to texture, pixel unit and blending
  double texture = 0;  // the same
};

// Counts what the frame and texture caches of a machine would move, on their tags alone. One run of quads of
// every eight is looked up, beginning with empty caches at the start of a draw.
class TrafficCounter {
 public:
  TrafficCounter(const Machine& machine, const MemoryLayout& layout);

  // Draws and clears in the order of the trace.
  Traffic of(const DrawJob& job);
  void clear();

 private:
  const Machine& machine_;
  const MemoryLayout& layout_;
  std::vector<std::uint8_t> cleared_;  // depth lines that hold the clear value and are not read
};

}  // namespace splatscope::sim
