#include <benchmark/benchmark.h>

#include "sim/simulate.h"
#include "sim/testing/random_trace.h"

// What it saves to leave out the units that no draw needs, and that draws go past those that they do not use.
namespace splatscope::sim {
namespace {

// Draws of depth alone: without colour, they need neither texture unit nor pixel unit nor blending.
void depth_only(benchmark::State& state, Scheduler scheduler, UnitChoice choice) {
  testing::RandomTrace made = testing::simple_trace(5000);
  std::get<Draw>(made.trace.commands[1]).state.color_write = false;
  for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
  made.work[0].texel_blocks.clear();
  const Machine machine = machine::load(machine::kGeForce4);
  Cycle cycles = 0;
  for (auto _ : state) cycles += simulate(made.trace, made.work, machine, scheduler, {}, {}, choice).cycles;
  state.counters["cycles"] = benchmark::Counter(static_cast<double>(cycles), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(depth_only, skip_ahead_needed_units, Scheduler::skip_ahead, UnitChoice::needed);
BENCHMARK_CAPTURE(depth_only, skip_ahead_all_units, Scheduler::skip_ahead, UnitChoice::all);
// The referee calls every unit in every cycle.
BENCHMARK_CAPTURE(depth_only, referee_needed_units, Scheduler::referee, UnitChoice::needed);
BENCHMARK_CAPTURE(depth_only, referee_all_units, Scheduler::referee, UnitChoice::all);

// The same triangles and quads on a machine with every unit, past fewer and fewer of them. The ways past are
// the machine's own, so that the cycles change too.
void draw_past(benchmark::State& state, Scheduler scheduler, void (*change)(Draw& draw)) {
  testing::RandomTrace made = testing::simple_trace(5000);
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  change(draw);
  if (!binds_texture(draw)) {
    for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
    made.work[0].texel_blocks.clear();
  }
  const Machine machine = machine::load(machine::kGeForce4);
  Cycle cycles = 0;
  for (auto _ : state)
    cycles = simulate(made.trace, made.work, machine, scheduler, {}, {}, UnitChoice::all).cycles;
  state.counters["cycles"] = static_cast<double>(cycles);
}
void nothing(Draw& /*draw*/) {}
void destination_read(Draw& draw) {
  draw.state.blend = false;
}
void texture(Draw& draw) {
  draw.texture.reset();
}
void color(Draw& draw) {
  draw.state.color_write = false;
}
void depth(Draw& draw) {
  draw.state.depth_test = draw.state.depth_write = false;
}
BENCHMARK_CAPTURE(draw_past, skip_ahead_nothing, Scheduler::skip_ahead, nothing);
BENCHMARK_CAPTURE(draw_past, skip_ahead_destination_read, Scheduler::skip_ahead, destination_read);
BENCHMARK_CAPTURE(draw_past, skip_ahead_texture, Scheduler::skip_ahead, texture);
BENCHMARK_CAPTURE(draw_past, skip_ahead_color, Scheduler::skip_ahead, color);
BENCHMARK_CAPTURE(draw_past, skip_ahead_depth, Scheduler::skip_ahead, depth);
BENCHMARK_CAPTURE(draw_past, referee_nothing, Scheduler::referee, nothing);
BENCHMARK_CAPTURE(draw_past, referee_destination_read, Scheduler::referee, destination_read);
BENCHMARK_CAPTURE(draw_past, referee_texture, Scheduler::referee, texture);
BENCHMARK_CAPTURE(draw_past, referee_color, Scheduler::referee, color);
BENCHMARK_CAPTURE(draw_past, referee_depth, Scheduler::referee, depth);

}  // namespace
}  // namespace splatscope::sim
