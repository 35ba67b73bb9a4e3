#pragma once

#include <cstdint>
#include <vector>

#include "model/machine/machine.h"
#include "sim/draw_jobs.h"

namespace splatscope::sim {

// Of a quad of a draw, on average: bytes to and from video memory, and texel blocks.
struct Traffic {
  double depth = 0;         // of every quad
  double color = 0;         // of a quad that goes on to texture, pixel unit and blending
  double texture = 0;       // the same
  double texel_blocks = 0;  // that such a quad reads
};

// What a request for so many bytes moves: whole bursts.
double in_bursts(double bytes, const Machine& machine);

// Counts what the frame and texture caches of a machine would move, on their tags alone: for the quads of
// sampled triangles (DrawWork::is_sampled), beginning with empty caches at the start of a draw.
class TrafficCounter {
 public:
  TrafficCounter(const Machine& machine, const MemoryLayout& layout);

  // Draws and clears in the order of the trace.
  Traffic of(const DrawJob& job);
  void clear() { cleared_ = machine_.depth.fast_clear; }

 private:
  void count_depth(const DrawJob& job, Traffic& traffic);
  void count_color(const DrawJob& job, Traffic& traffic) const;

  const Machine& machine_;
  const MemoryLayout& layout_;
  bool cleared_ = false;                // clear depth lines are not read
  std::vector<std::uint8_t> is_clear_;  // of the depth lines of a triangle
};

}  // namespace splatscope::sim
