#include <benchmark/benchmark.h>

#include "sim/simulate.h"
#include "sim/testing/random_trace.h"

// What it saves to leave out the units that no draw needs.
namespace splatscope::sim {
namespace {

// Draws of depth alone: without colour, they need neither texture unit nor pixel unit nor blending.
void depth_only(benchmark::State& state, Scheduler scheduler, UnitChoice choice) {
  testing::RandomTrace made = testing::simple_trace(5000);
  std::get<Draw>(made.trace.commands[1]).state.color_write = false;
  for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
  made.work[0].texel_blocks.clear();
  const Machine machine = machine::load("geforce4-ti4400");
  Cycle cycles = 0;
  for (auto _ : state) cycles += simulate(made.trace, made.work, machine, scheduler, {}, {}, choice).cycles;
  state.counters["cycles"] = benchmark::Counter(static_cast<double>(cycles), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(depth_only, skip_ahead_needed_units, Scheduler::skip_ahead, UnitChoice::needed);
BENCHMARK_CAPTURE(depth_only, skip_ahead_all_units, Scheduler::skip_ahead, UnitChoice::all);
// The referee calls every unit in every cycle.
BENCHMARK_CAPTURE(depth_only, referee_needed_units, Scheduler::referee, UnitChoice::needed);
BENCHMARK_CAPTURE(depth_only, referee_all_units, Scheduler::referee, UnitChoice::all);

}  // namespace
}  // namespace splatscope::sim
