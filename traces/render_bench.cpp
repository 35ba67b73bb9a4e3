#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "model/machine/machine.h"
#include "model/render.h"
#include "traces/recorder.h"
#include "traces/scene.h"

namespace splatscope::traces {
namespace {

// Table 1's frame of 65,536 EWA surfels, from its trace in memory to the frame: recording is not timed. With
// the work record, which timing needs, or without; by the number of threads.
void render_frame(benchmark::State& state, bool record_work) {
  const Machine machine = machine::load("geforce4-ti4400");
  static const Recording recording = record(load_scene("checkerboard-ewa-per-surfel"), machine.numbers, {});
  const auto threads = static_cast<std::size_t>(state.range(0));
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  RenderOptions options;
  options.formats = machine.numbers;
  options.vertex_cache_entries = machine.vertex.cache_entries;
  options.record_work = record_work;
  for (auto _ : state) benchmark::DoNotOptimize(render(recording.trace, options));
}
BENCHMARK_CAPTURE(render_frame, frame, false)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(render_frame, frame_and_work, true)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace splatscope::traces
