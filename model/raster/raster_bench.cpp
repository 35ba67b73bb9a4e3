#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <random>
#include <vector>

#include "model/output/output.h"
#include "model/raster/raster.h"

namespace splatscope::raster {
namespace {

constexpr primitive::Viewport kViewport{512, 512};
constexpr std::size_t kTriangles = Corners::kCapacity;

// Triangles of about `size` pixels a side, anywhere in the window.
std::unique_ptr<Corners> triangles_of(double size) {
  auto corners = std::make_unique<Corners>();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 512), offset(-size, size), z(0.2, 0.8);
  for (std::size_t i = 0; i < kTriangles; ++i) {
    const double x = place(random), y = place(random);
    for (std::size_t corner = 0; corner < 3; ++corner)
      corners->set(i, corner, x + offset(random), y + offset(random), z(random), 1);
  }
  return corners;
}

void count(benchmark::State& state, double each) {
  state.counters["triangles"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * each, benchmark::Counter::kIsRate);
}

void set_up_triangles(benchmark::State& state) {
  const auto corners = triangles_of(4);
  std::vector<TriangleSetup> setups(kTriangles);
  for (auto _ : state) {
    set_up(*corners, {kViewport}, setups);
    benchmark::DoNotOptimize(setups.data());
  }
  count(state, kTriangles);
}
BENCHMARK(set_up_triangles);

// Coverage alone, or with the depth test; by the size of the triangles (pixels).
void rasterise(benchmark::State& state, bool depth_test) {
  const auto corners = triangles_of(static_cast<double>(state.range(0)));
  std::vector<TriangleSetup> setups(kTriangles);
  set_up(*corners, {kViewport}, setups);
  std::vector<std::uint32_t> stored(512 * 512, output::quantize_depth(1, DepthFormat::z24));
  const DepthTarget depth{stored, kViewport, DepthFormat::z24, depth_test, depth_test};
  const auto windows = std::make_unique<std::array<Window, kMaxWindows>>();
  for (auto _ : state) {
    for (const TriangleSetup& setup : setups) {
      if (!setup.covers) continue;
      for (int y = setup.top & ~1; y < setup.bottom; y += kWindow)
        benchmark::DoNotOptimize(rasterize_band(setup, depth, y, *windows));
    }
  }
  count(state, kTriangles);
}
BENCHMARK_CAPTURE(rasterise, coverage, false)->Arg(4)->Arg(64);
BENCHMARK_CAPTURE(rasterise, depth, true)->Arg(4)->Arg(64);

}  // namespace
}  // namespace splatscope::raster
