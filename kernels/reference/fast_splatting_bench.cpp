#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "kernels/reference/fast_splatting.h"
#include "kernels/reference/screen_space.h"
#include "kernels/reference/sphere.h"

namespace splatscope::kernels {
namespace {

// Points of the whole model a second, as the papers count them: those that face away or are hidden too.
void run(benchmark::State& state, const auto& draw) {
  const auto threads = static_cast<std::size_t>(state.range(1));
  const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  const int size = static_cast<int>(state.range(0));
  const View view = sphere_view(size);
  for (auto _ : state) benchmark::DoNotOptimize(draw(view));
}

constexpr int kPoints = 430'000;

void count(benchmark::State& state) {
  state.counters["splats"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kPoints, benchmark::Counter::kIsRate);
}

void fast(benchmark::State& state) {
  FastSplatting splatting(sphere(kPoints));
  run(state, [&](const View& view) {
    return splatting.draw(view, {.depth_offset = sphere_spacing(kPoints), .cull_back_faces = true});
  });
  count(state);
}

void double_precision(benchmark::State& state) {
  const std::vector<Surfel> surfels = sphere(kPoints);
  run(state, [&](const View& view) {
    return screen_space_ewa(view, surfels,
                            {.filter = {.shape = CutoffShape::circle},
                             .depth_offset = sphere_spacing(kPoints),
                             .cull_back_faces = true});
  });
  count(state);
}

void sizes_and_threads(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"pixels", "threads"})->ArgsProduct({{256, 512, 1024}, {1, 2}});
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(fast)->Apply(sizes_and_threads);
BENCHMARK(double_precision)->Args({512, 2})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace splatscope::kernels
