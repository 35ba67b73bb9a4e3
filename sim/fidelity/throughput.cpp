#include "sim/fidelity/throughput.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/draw_jobs.h"
#include "sim/fidelity/traffic.h"
#include "sim/units/vertex/throughput.h"

namespace splatscope::sim {
namespace {

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
constexpr std::size_t kStretch = 64;

double whole_clocks(double items, int a_clock) {
  return std::ceil(items / a_clock);
}

class Estimate {
 public:
  Estimate(const Trace& trace, std::span<const DrawWork> work, const Machine& machine)
      : trace_(trace),
        machine_(machine),
        layout_(lay_out(trace, machine)),
        draws_(prepare_draws(trace, work, machine, layout_)),
        traffic_(machine, layout_) {
    for (const auto& slots : draws_.vertex_programs) {
      clocks_per_vertex_.push_back(throughput(slots, machine.vertex).clocks_per_vertex);
    }
  }

  Result result() {
    Result result;
    std::size_t next = 0;
    for (const Command& command : trace_.commands) {
      const double prepared = core_clocks(machine_.host.command_nanoseconds);
      busy_[kHost] += prepared;
      cycles_ += prepared;
      if (std::holds_alternative<Draw>(command)) add_draw(draws_.jobs[next++]);
      if (std::holds_alternative<Clear>(command)) add_clear();
      if (std::holds_alternative<NormalizeOnHost>(command)) add_normalization();
      result.command_ends.push_back(static_cast<Cycle>(std::llround(cycles_)));
    }
    result.cycles = static_cast<Cycle>(std::llround(cycles_));
    result.seconds = cycles_ / (1e6 * machine_.clock.core_megahertz);
    result.frame_cycles = cycles_of_frames(trace_, result);
    add_units(result);
    return result;
  }

 private:
  double core_clocks(double nanoseconds) const { return nanoseconds * machine_.clock.core_megahertz / 1000; }

  double memory_clocks(double bytes) const {
    return bytes / (static_cast<double>(machine_.memory.channels) * machine_.memory.channel_bytes_per_clock);
  }

  double agp_clocks(double bytes) const {
    return bytes / machine_.agp.bytes_per_clock * machine_.clock.core_megahertz /
           machine_.clock.bus_megahertz;
  }

  // From the first index to the last pixel, where nothing waits.
  double latency(const DrawJob& job) const {
    const double read = machine_.memory.precharge_clocks + machine_.memory.activate_clocks +
                        machine_.memory.cas_clocks + machine_.memory.return_latency;
    const double vertex = static_cast<double>(draws_.vertex_programs[job.vertex_program].size()) *
                          std::max(1, machine_.vertex.vector_latency);
    const double pixels = job.draw->state.color_write ? machine_.texture.latency + machine_.pixel.latency : 0;
    return 2 * read + vertex + machine_.setup.latency + machine_.raster.latency + machine_.depth.latency +
           pixels;
  }

  void add_clear() {
    double bytes = layout_.color.bytes();
    if (!machine_.depth.fast_clear) bytes += layout_.depth.bytes();
    traffic_.clear();
    busy_[kCommand] += memory_clocks(bytes);
    busy_[kMemory] += memory_clocks(bytes);
    cycles_ += memory_clocks(bytes);
  }

  void add_normalization() {
    const Machine::Host& host = machine_.host;
    const int bytes = static_cast<int>(layout_.color.bytes_per_pixel);
    const double read = whole_clocks(bytes, host.uncached_read_bytes) * host.uncached_read_nanoseconds;
    const double write =
        whole_clocks(bytes, host.write_bytes_per_clock) * 1000 / machine_.clock.bus_megahertz;
    const double clocks =
        core_clocks((read + host.division_nanoseconds + write) * trace_.width * trace_.height);
    busy_[kHost] += clocks;
    cycles_ += clocks;
  }

  void add_draw(const DrawJob& job) {
    const DrawWork& work = *job.work;
    const Traffic traffic = traffic_.of(job);
    Position at;
    while (at.triangle < work.triangles.size()) {
      const Clocks stretch = clocks_of_stretch(job, traffic, at);
      for (std::size_t i = 0; i < kStages; ++i) busy_[i] += stretch[i];
      cycles_ += *std::ranges::max_element(stretch);
    }
    cycles_ += latency(job);
  }

  struct Position {
    std::size_t triangle = 0;
    std::size_t quad = 0;
  };

  Clocks clocks_of_stretch(const DrawJob& job, const Traffic& traffic, Position& at) const {
    const DrawWork& work = *job.work;
    const std::size_t end = std::min(at.triangle + kStretch, work.triangles.size());
    const auto triangles = static_cast<double>(end - at.triangle);
    const int width = machine_.pixel.quads_per_clock;
    double vertices = 0, pieces = 0, quads = 0, colored = 0, blocks = 0;
    Clocks clocks{};
    for (; at.triangle < end; ++at.triangle) {
      const TriangleWork& triangle = work.triangles[at.triangle];
      vertices += triangle.new_vertices;
      clocks[kPrimitive] += machine_.primitive.clocks_per_triangle;
      if (triangle.pieces == 0) continue;
      pieces += triangle.pieces;
      clocks[kPrimitive] += (triangle.pieces - 1) * machine_.primitive.clip_clocks;
      clocks[kRaster] += std::max({1.0, whole_clocks(triangle.tile_count, machine_.raster.tiles_per_clock),
                                   whole_clocks(triangle.quad_count, width)});
      quads += triangle.quad_count;
      for (const std::size_t last = at.quad + triangle.quad_count; at.quad < last; ++at.quad) {
        const QuadWork& quad = work.quads[at.quad];
        colored += is_colored(job, quad);
        blocks += quad.texel_block_count;
      }
    }
    const double indices = 3 * triangles;
    const double fetched = vertices * job.draw->vertex_stride;
    clocks[kFetch] = std::max(indices / machine_.fetch.indices_per_clock, vertices);
    clocks[kVertex] = vertices * clocks_per_vertex_[job.vertex_program] / machine_.vertex.units;
    clocks[kPrimitive] = std::max(clocks[kPrimitive], vertices);
    clocks[kSetup] = pieces * machine_.setup.clocks_per_triangle;
    clocks[kDepth] = quads / width;
    clocks[kTexture] = std::max(blocks / machine_.texture.lookups_per_clock, colored / width);
    clocks[kPixel] = colored * static_cast<double>(job.pixel_clocks) / width;
    clocks[kBlend] = colored / width;
    double bytes = quads * traffic.depth + colored * (traffic.color + traffic.texture);
    const auto in_agp = [&](std::uint32_t buffer) {
      return trace_.buffers[buffer].place == MemoryPlace::agp;
    };
    (in_agp(job.draw->vertex_buffer) ? clocks[kAgp] : bytes) += fetched;
    (in_agp(job.draw->index_buffer) ? clocks[kAgp] : bytes) += 2 * indices;
    clocks[kAgp] = agp_clocks(clocks[kAgp]);
    clocks[kMemory] = memory_clocks(bytes);
    return clocks;
  }

  void add_unit(Result& result, const std::string& name, double busy) const {
    UnitBooks books;
    books.name = name;
    books.busy = std::min(result.cycles, static_cast<Cycle>(std::llround(busy)));
    books.starved = result.cycles - books.busy;
    result.units.push_back(books);
  }

  void add_units(Result& result) const {
    const Needs needs = needs_of(trace_);
    add_unit(result, "vertex_fetch", busy_[kFetch]);
    for (int i = 0; i < machine_.vertex.units; ++i)
      add_unit(result, "vertex" + std::to_string(i), busy_[kVertex]);
    add_unit(result, "primitive", busy_[kPrimitive]);
    add_unit(result, "setup", busy_[kSetup]);
    add_unit(result, "raster", busy_[kRaster]);
    if (needs.depth) add_unit(result, "depth", busy_[kDepth]);
    if (needs.texture) add_unit(result, "texture", busy_[kTexture]);
    if (needs.color) add_unit(result, "pixel", busy_[kPixel]);
    if (needs.color) add_unit(result, "blend", busy_[kBlend]);
    for (int i = 0; i < machine_.memory.channels; ++i)
      add_unit(result, "memory" + std::to_string(i), busy_[kMemory]);
    add_unit(result, "command", busy_[kCommand]);
    if (needs.agp) add_unit(result, "agp", busy_[kAgp]);
    add_unit(result, "host", busy_[kHost]);
    result.units_left_out = units_left_out(needs);
  }

  const Trace& trace_;
  const Machine& machine_;
  MemoryLayout layout_;
  PreparedDraws draws_;
  TrafficCounter traffic_;
  std::vector<double> clocks_per_vertex_;  // by program
  double cycles_ = 0;
  Clocks busy_{};
};

}  // namespace

Result estimate_throughput(const Trace& trace, std::span<const DrawWork> work, const Machine& machine) {
  return Estimate(trace, work, machine).result();
}

}  // namespace splatscope::sim
