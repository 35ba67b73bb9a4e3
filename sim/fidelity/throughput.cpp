#include "sim/fidelity/throughput.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "model/error.h"
#include "sim/draw_jobs.h"
#include "sim/fidelity/stretches.h"
#include "sim/units/host/host.h"

namespace splatscope::sim {

class ThroughputEstimate::State {
 public:
  State(const Trace& trace, const Machine& machine, const WhatIf& what_if)
      : trace_(trace),
        machine_(machine),
        what_if_(what_if),
        layout_(lay_out(trace, machine)),
        draws_(prepare_draws(trace, machine, layout_)),
        needs_(needs_of(trace, draws_.jobs)),
        stretches_(trace, machine, layout_, draws_, what_if) {}

  void add(const DrawWork& work) {
    if (next_draw_ == draws_.jobs.size()) throw ModelError("there are more work records than draws");
    while (!std::holds_alternative<Draw>(trace_.commands[ends_.size()])) add_command();
    DrawJob& job = draws_.jobs[next_draw_++];
    give_work(job, work, true);
    begin_command();
    add_draw(job, work);
    end_command();
  }

  Result result() {
    if (next_draw_ != draws_.jobs.size()) throw ModelError("there are not as many work records as draws");
    while (ends_.size() < trace_.commands.size()) add_command();
    Result result;
    result.command_ends = ends_;
    result.cycles = static_cast<Cycle>(std::llround(cycles_));
    result.seconds = seconds_of(result.cycles, period_of(machine_.clock.core_megahertz));
    result.frame_cycles = cycles_of_frames(trace_, result);
    add_units(result);
    return result;
  }

 private:
  void begin_command() {
    const double prepared = core_clocks(machine_.host.command_nanoseconds);
    busy_[kHost] += prepared;
    cycles_ += prepared;
  }
  void end_command() { ends_.push_back(static_cast<Cycle>(std::llround(cycles_))); }

  // One that is no draw.
  void add_command() {
    const Command& command = trace_.commands[ends_.size()];
    begin_command();
    if (std::holds_alternative<Clear>(command)) add_clear();
    if (std::holds_alternative<NormalizeOnHost>(command)) add_normalization();
    end_command();
  }

  double core_clocks(double nanoseconds) const { return nanoseconds * machine_.clock.core_megahertz / 1000; }

  // Of the first data of a buffer.
  double read_latency(std::uint32_t buffer) const {
    if (trace_.buffers[buffer].place == MemoryPlace::agp)
      return core_clocks(machine_.agp.latency_nanoseconds);
    return machine_.memory.precharge_clocks + machine_.memory.activate_clocks + machine_.memory.cas_clocks +
           machine_.memory.return_latency;
  }

  // From the first index to the last pixel, where nothing waits. Draws go past the units that they do not
  // use, and end where nothing is left of them. `busy`: all of its clocks.
  double latency(const DrawJob& job, const Clocks& busy) const {
    const double read = read_latency(job.draw->index_buffer) + read_latency(job.draw->vertex_buffer);
    const double vertex = static_cast<double>(draws_.vertex_programs[job.vertex_program].size()) *
                          std::max(1, machine_.vertex.vector_latency);
    const bool color = job.draw->state.color_write;  // else a quad ends at the depth test, before its latency
    const double triangles = busy[kSetup] > 0 ? machine_.setup.latency + machine_.raster.latency : 0;
    const double depth = busy[kDepth] > 0 && color && uses_depth(*job.draw) ? machine_.depth.latency : 0;
    const double texture = busy[kBlend] > 0 && job.textured ? machine_.texture.latency : 0;
    const double pixels = busy[kBlend] > 0 ? machine_.pixel.latency : 0;
    return read + vertex + triangles + depth + texture + pixels;
  }

  void add_clear() {
    double bytes = layout_.color.bytes();
    if (needs_.depth && !machine_.depth.fast_clear) bytes += layout_.depth.bytes();
    stretches_.clear();
    busy_[kCommand] += memory_clocks(bytes, machine_);
    busy_[kMemory] += memory_clocks(bytes, machine_);
    cycles_ += memory_clocks(bytes, machine_);
  }

  void add_division() {
    const double bytes = 2.0 * layout_.color.bytes();
    const double clocks = std::max(
        whole_clocks(static_cast<double>(trace_.width) * trace_.height, what_if_.divided_pixels_per_clock),
        memory_clocks(bytes, machine_));
    busy_[kCommand] += clocks;
    busy_[kMemory] += memory_clocks(bytes, machine_);
    cycles_ += clocks;
  }

  void add_normalization() {
    if (what_if_.divided_pixels_per_clock > 0) return add_division();
    const Femtoseconds pixel = Host::pixel_time(machine_.host, period_of(machine_.clock.bus_megahertz),
                                                static_cast<int>(layout_.color.bytes_per_pixel));
    const double clocks = core_clocks(1e-6 * static_cast<double>(pixel) * trace_.width * trace_.height);
    busy_[kHost] += clocks;
    cycles_ += clocks;
  }

  void add_draw(const DrawJob& job, const DrawWork& work) {
    if (work.triangles.empty()) return;  // begins no unit
    stretches_.begin(job);
    stretches_.add(work);
    Clocks busy{};
    for (const Clocks& stretch : stretches_.clocks()) {
      for (std::size_t i = 0; i < kStages; ++i) busy[i] += stretch[i];
      cycles_ += *std::ranges::max_element(stretch);
    }
    for (std::size_t i = 0; i < kStages; ++i) busy_[i] += busy[i];
    cycles_ += latency(job, busy);
  }

  void add_unit(Result& result, const std::string& name, double busy) const {
    UnitBooks books;
    books.name = name;
    books.busy = std::min(result.cycles, static_cast<Cycle>(std::llround(busy)));
    books.starved = result.cycles - books.busy;
    result.units.push_back(books);
  }

  void add_units(Result& result) const {
    add_unit(result, "vertex_fetch", busy_[kFetch]);
    for (int i = 0; i < machine_.vertex.units; ++i)
      add_unit(result, "vertex" + std::to_string(i), busy_[kVertex]);
    add_unit(result, "primitive", busy_[kPrimitive]);
    add_unit(result, "setup", busy_[kSetup]);
    add_unit(result, "raster", busy_[kRaster]);
    if (needs_.depth) add_unit(result, "depth", busy_[kDepth]);
    if (needs_.texture) add_unit(result, "texture", busy_[kTexture]);
    if (needs_.color) {
      add_unit(result, "pixel", busy_[kPixel]);
      add_unit(result, "blend", busy_[kBlend]);
    }
    for (int i = 0; i < machine_.memory.channels; ++i)
      add_unit(result, "memory" + std::to_string(i), busy_[kMemory]);
    add_unit(result, "command", busy_[kCommand]);
    if (needs_.agp) add_unit(result, "agp", busy_[kAgp]);
    add_unit(result, "host", busy_[kHost]);
    result.units_left_out = left_out(trace_, needs_, draws_.jobs);
  }

  const Trace& trace_;
  const Machine& machine_;
  const WhatIf what_if_;
  MemoryLayout layout_;
  PreparedDraws draws_;
  const Needs needs_;
  Stretches stretches_;
  std::size_t next_draw_ = 0;
  std::vector<Cycle> ends_;  // of the commands so far
  double cycles_ = 0;
  Clocks busy_{};
};

ThroughputEstimate::ThroughputEstimate(const Trace& trace, const Machine& machine, const WhatIf& what_if)
    : state_(std::make_unique<State>(trace, machine, what_if)) {}
ThroughputEstimate::~ThroughputEstimate() = default;

void ThroughputEstimate::add(const DrawWork& work) {
  state_->add(work);
}
Result ThroughputEstimate::result() {
  return state_->result();
}

Result estimate_throughput(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                           const WhatIf& what_if) {
  ThroughputEstimate estimate(trace, machine, what_if);
  for (const DrawWork& draw : work) estimate.add(draw);
  return estimate.result();
}

}  // namespace splatscope::sim
