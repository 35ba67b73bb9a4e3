#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "model/machine/machine.h"
#include "model/render.h"
#include "traces/recorder.h"
#include "traces/scene.h"

namespace splatscope::traces {
namespace {

// Table 1's frame of 65,536 EWA surfels, from its trace in memory to the frame: recording is not timed. With
// the whole work record, with the samples that an estimate needs, or with none; by the number of threads.
void render_frame(benchmark::State& state, Record record_what) {
  const Machine machine = machine::load(machine::kGeForce4);
  static const Recording recording = record(load_scene("checkerboard-ewa-per-surfel"), machine.numbers, {});
  const auto threads = static_cast<std::size_t>(state.range(0));
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  const RenderOptions options = render_options(machine, record_what);
  for (auto _ : state) benchmark::DoNotOptimize(render(recording.trace, options));
}
BENCHMARK_CAPTURE(render_frame, frame, Record::nothing)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(render_frame, frame_and_samples, Record::samples)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(render_frame, frame_and_work, Record::everything)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace splatscope::traces
