#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "kernels/reference/volume/fast_volume.h"
#include "kernels/reference/volume/procedural.h"

namespace splatscope::kernels {
namespace {

const TransferFunction kTissue({{0.15, {0, {0.9, 0.6, 0.5}}},
                                {0.2, {0.02, {0.9, 0.6, 0.5}}},
                                {0.5, {0.05, {0.9, 0.8, 0.7}}},
                                {0.7, {0.5, {1, 1, 0.9}}}});

// A frame of the size of the paper's head (Zwicker 2002, Fig. 16): skin and skull, the skull as flat kernels.
void head(benchmark::State& state) {
  const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(state.range(0)));
  FastVolume volume(grid_splats(head_stand_in({256, 256, 108}), kTissue, 1, {.low = 0.6, .high = 1}));
  const VolumeSettings settings{.cutoff = static_cast<double>(state.range(1))};
  const View view = look_at({1.8, -4.2, 0.9}, {0, 0, 0}, {0, 0, 1}, 28, 512, 512, 0.1, 100);
  for (auto _ : state) benchmark::DoNotOptimize(volume.draw(view, settings));
  const auto splats = static_cast<double>(volume.splats().splats.size());
  state.counters["voxels"] = splats;
  state.counters["voxels/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * splats, benchmark::Counter::kIsRate);
}
BENCHMARK(head)
    ->ArgNames({"threads", "cutoff"})
    ->ArgsProduct({{1, 2}, {4, 11}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace splatscope::kernels
