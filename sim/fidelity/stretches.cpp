#include "sim/fidelity/stretches.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace splatscope::sim {
namespace {

constexpr std::size_t kStretchesAtOnce = 64;  // fewer are not worth a task

}  // namespace

double whole_clocks(double items, int a_clock) {
  return std::ceil(items / a_clock);
}

double memory_clocks(double bytes, const Machine& machine) {
  return bytes / (static_cast<double>(machine.memory.channels) * machine.memory.channel_bytes_per_clock);
}

Stretches::Stretches(const Trace& trace, const Machine& machine, const MemoryLayout& layout,
                     const PreparedDraws& draws, const WhatIf& what_if)
    : trace_(trace),
      machine_(machine),
      what_if_(what_if),
      traffic_(machine, layout),
      clocks_per_vertex_(draws.vertex_programs.size()) {
  for (const DrawJob& job : draws.jobs) {
    double& clocks = clocks_per_vertex_[job.vertex_program];
    const auto& slots = draws.vertex_programs[job.vertex_program];
    if (clocks == 0) clocks = clocks_of_vertex(trace, *job.draw, slots, machine.vertex, what_if);
  }
}

// Core clocks of a line over the bus: whole clocks of it, or what a full queue of requests waits for one.
double Stretches::clocks_per_agp_line() const {
  const Machine::Agp& agp = machine_.agp;
  const double transfer = whole_clocks(machine_.fetch.line_bytes, agp.bytes_per_clock);
  const double latency = agp.latency_nanoseconds * machine_.clock.bus_megahertz / 1000;
  return std::max(transfer, (latency + transfer) / agp.queue) * machine_.clock.core_megahertz /
         machine_.clock.bus_megahertz;
}

void Stretches::begin(const DrawJob& job) {
  job_ = &job;
  triangles_ = 0;
  sums_.clear();
  traffic_.begin(job);
}

// What the caches do is counted triangle by triangle, beside the sums of the stretches.
void Stretches::add(const DrawWork& part) {
  const std::uint64_t first = std::exchange(triangles_, triangles_ + part.triangles.size());
  sums_.resize((triangles_ + kStretch - 1) / kStretch);
  const auto depth = [&] { traffic_.add_depth(part, first); };
  const auto color = [&] { traffic_.add_color(part, first); };
  const auto sum = [&](const tbb::blocked_range<std::uint64_t>& stretches) {
    for (std::uint64_t i = stretches.begin(); i != stretches.end(); ++i) {
      const std::uint64_t from = std::max(first, i * kStretch), to = std::min(triangles_, (i + 1) * kStretch);
      add(std::span(part.triangles).subspan(from - first, to - from), sums_[i]);
    }
  };
  const tbb::blocked_range<std::uint64_t> stretches(first / kStretch, sums_.size(), kStretchesAtOnce);
  if (stretches.is_divisible()) {
    tbb::parallel_invoke(depth, color, [&] { tbb::parallel_for(stretches, sum); });
  } else {
    depth();
    color();
    sum(stretches);
  }
}

std::vector<Clocks> Stretches::clocks() const {
  const Traffic traffic = traffic_.traffic();
  std::vector<Clocks> clocks;
  for (const Sums& stretch : sums_) clocks.push_back(clocks_of(*job_, traffic, stretch, clocks.empty()));
  return clocks;
}

void Stretches::add(std::span<const TriangleWork> triangles, Sums& sums) const {
  const ClocksOf tile_clocks(machine_.raster.tiles_per_clock), quad_clocks(machine_.pixel.quads_per_clock);
  sums.triangles += triangles.size();
  for (const TriangleWork& triangle : triangles) {
    sums.vertices += triangle.new_vertices;
    if (triangle.pieces == 0) continue;
    sums.pieces += triangle.pieces;
    ++sums.in_frame;
    sums.raster_clocks += std::max({1U, tile_clocks(triangle.tile_count), quad_clocks(triangle.quad_count)});
    sums.quads += triangle.quad_count;
    sums.quads_passed += triangle.quads_passed;
  }
}

Clocks Stretches::clocks_of(const DrawJob& job, const Traffic& traffic, const Sums& sums, bool first) const {
  const int width = machine_.pixel.quads_per_clock;
  auto vertices = static_cast<double>(sums.vertices), pieces = static_cast<double>(sums.pieces);
  const auto quads = static_cast<double>(sums.quads);
  const double colored = job.draw->state.color_write ? static_cast<double>(sums.quads_passed) : 0;
  Clocks clocks{};
  clocks[kPrimitive] = static_cast<double>(sums.triangles) * machine_.primitive.clocks_per_triangle +
                       static_cast<double>(sums.pieces - sums.in_frame) * machine_.primitive.clip_clocks;
  clocks[kRaster] = static_cast<double>(sums.raster_clocks);
  const bool a_quad = reads_a_vertex_a_quad(what_if_);
  const double indices = a_quad ? 0 : 3 * static_cast<double>(sums.triangles);
  const double read = a_quad ? vertices / 4 : vertices;
  const double fetched = read * bytes_of_vertex(*job.draw, what_if_);
  clocks[kFetch] = std::max(indices / 3 * whole_clocks(3, machine_.fetch.indices_per_clock), read);
  clocks[kVertex] = vertices * clocks_per_vertex_[job.vertex_program] / machine_.vertex.units;
  if (what_if_.point_sprites) {
    clocks[kPrimitive] /= 2;
    pieces /= 2;
    vertices = read;
  }
  clocks[kPrimitive] = std::max(clocks[kPrimitive], vertices);
  // What passes a unit holds a place of its queue for the unit's latency, once the queue is full. Draws go
  // past the units that they do not use.
  const auto through = [first](double clocks, double items, int latency, int queue) {
    return std::max(clocks, (items - (first ? queue : 0)) * latency / queue);
  };
  const Machine& m = machine_;
  clocks[kSetup] = through(pieces * m.setup.clocks_per_triangle, pieces, m.setup.latency, m.setup.queue);
  if (uses_depth(*job.draw) || job.draw->state.color_write)
    clocks[kRaster] = through(clocks[kRaster], quads, m.raster.latency, m.raster.queue);
  if (uses_depth(*job.draw)) clocks[kDepth] = through(quads / width, colored, m.depth.latency, m.depth.queue);
  if (job.textured)
    clocks[kTexture] =
        through(std::max(colored * traffic.texel_blocks / m.texture.lookups_per_clock, colored / width),
                colored, m.texture.latency, m.texture.queue);
  clocks[kPixel] = through(colored * static_cast<double>(job.pixel_clocks) / width, colored, m.pixel.latency,
                           m.pixel.queue);
  clocks[kBlend] = colored / width;
  double bytes = quads * traffic.depth + colored * (traffic.color + traffic.texture);
  const auto in_agp = [&](std::uint32_t buffer) { return trace_.buffers[buffer].place == MemoryPlace::agp; };
  const double in_video = in_bursts(machine_.fetch.line_bytes, machine_) / machine_.fetch.line_bytes;
  const auto fetch = [&](std::uint32_t buffer, double some) {
    in_agp(buffer) ? clocks[kAgp] += some : bytes += some * in_video;
  };
  fetch(job.draw->vertex_buffer, fetched);
  fetch(job.draw->index_buffer, 2 * indices);
  clocks[kAgp] *= clocks_per_agp_line() / machine_.fetch.line_bytes;
  clocks[kMemory] = memory_clocks(bytes, machine_);
  return clocks;
}

}  // namespace splatscope::sim
