#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "sim/draw_jobs.h"
#include "sim/fidelity/traffic.h"
#include "sim/fidelity/what_if.h"

namespace splatscope::sim {

enum Stage : std::uint8_t {
  kFetch,
  kVertex,
  kPrimitive,
  kSetup,
  kRaster,
  kDepth,
  kTexture,
  kPixel,
  kBlend,
  kMemory,
  kAgp,
  kCommand,
  kHost,
  kStages
};
using Clocks = std::array<double, kStages>;  // of the core, by stage

// Triangles that the queues between the units hold together, about: units that far apart can be busy with
// work of different kinds, so shorter stretches would see bottlenecks that the queues smooth away.
inline constexpr std::size_t kStretch = 64;

double whole_clocks(double items, int a_clock);
double memory_clocks(double bytes, const Machine& machine);  // of all channels together

// Clocks for up to 2^26 items, more than a frame has quads, at 1 to 16 a clock: exactly their quotient,
// rounded up. Two divisions would take longer than all else that is done for a triangle.
class ClocksOf {
 public:
  explicit ClocksOf(int a_clock)
      : a_clock_(static_cast<std::uint64_t>(a_clock)), reciprocal_((std::uint64_t{1} << 36) / a_clock_ + 1) {}
  std::uint32_t operator()(std::uint32_t items) const {
    return static_cast<std::uint32_t>((items + a_clock_ - 1) * reciprocal_ >> 36);
  }

 private:
  std::uint64_t a_clock_, reciprocal_;
};

// What each stage would take for a stretch of triangles if it never waited.
class Stretches {
 public:
  // All outlive it.
  Stretches(const Trace& trace, const Machine& machine, const MemoryLayout& layout,
            const PreparedDraws& draws, const WhatIf& what_if = {});

  // Draws and clears in the order of the trace. All of a draw's work is added, in parts or at once.
  void clear() { traffic_.clear(); }
  void begin(const DrawJob& job);
  void add(const DrawWork& part);
  // Then, of the draw, its stretches of kStretch triangles in order; the last may be shorter.
  std::vector<Clocks> clocks() const;

 private:
  // Of a stretch.
  struct Sums {
    std::size_t triangles = 0;
    std::uint32_t vertices = 0, pieces = 0, in_frame = 0;  // triangles with a piece
    std::uint64_t raster_clocks = 0, quads = 0, quads_passed = 0;
  };

  void add(std::span<const TriangleWork> triangles, Sums& sums) const;
  // `first`: of its draw.
  Clocks clocks_of(const DrawJob& job, const Traffic& traffic, const Sums& sums, bool first) const;
  double clocks_per_agp_line() const;

  const Trace& trace_;
  const Machine& machine_;
  const WhatIf what_if_;
  TrafficCounter traffic_;
  std::vector<double> clocks_per_vertex_;  // by program
  const DrawJob* job_ = nullptr;
  std::uint64_t triangles_ = 0;  // of the draw so far
  std::vector<Sums> sums_;       // of its stretches
};

}  // namespace splatscope::sim
