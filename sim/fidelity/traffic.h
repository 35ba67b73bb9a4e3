#pragma once

#include <cstdint>
#include <vector>

#include "model/machine/machine.h"
#include "sim/draw_jobs.h"
#include "sim/units/cache/cache_tags.h"

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
  void clear() { cleared_ = machine_.depth.fast_clear; }
  void begin(const DrawJob& job);
  // The parts of the draw's work in order, each after so many triangles of it. Depth and what lies behind it
  // share no cache: both may be counted beside one another.
  void add_depth(const DrawWork& part, std::uint64_t first_triangle);
  void add_color(const DrawWork& part, std::uint64_t first_triangle);
  // Of the draw, when all of it is added.
  Traffic traffic() const;

 private:
  // Of the quads of a draw.
  struct Counted {
    double quads = 0, bytes = 0;
  };

  const Machine& machine_;
  const MemoryLayout& layout_;
  bool cleared_ = false;                // clear depth lines are not read
  std::vector<std::uint8_t> is_clear_;  // of the depth lines of a triangle
  const DrawJob* job_ = nullptr;
  CacheTags depth_tags_, color_tags_, texture_tags_;
  Counted depth_, color_;
  double texture_bytes_ = 0, texel_blocks_ = 0;
};

}  // namespace splatscope::sim
