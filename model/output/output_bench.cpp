#include <benchmark/benchmark.h>

#include <array>
#include <random>

#include "model/output/output.h"

namespace splatscope::output {
namespace {

constexpr std::size_t kFragments = 64;

// Blends of one batch: what splatting uses, added by SIMD, and one that reads the destination.
void blend(benchmark::State& state, BlendFactor source, BlendFactor destination) {
  Frame frame(512, 512, NumberFormats{});
  DrawState draw;
  draw.blend = true;
  draw.source_factor = source;
  draw.destination_factor = destination;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(0, 1);
  alignas(64) std::array<std::array<float, kFragments>, 4> colors;
  for (auto& channel : colors)
    for (float& color : channel) color = value(random);
  std::array<std::uint32_t, kFragments> pixels;
  for (std::uint32_t& pixel : pixels) pixel = static_cast<std::uint32_t>(random() % (512 * 512));
  for (auto _ : state) {
    write_colors({colors[0].data(), colors[1].data(), colors[2].data(), colors[3].data()}, pixels, draw,
                 frame);
    benchmark::DoNotOptimize(frame.colors8.data());
  }
  state.counters["fragments"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kFragments, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(blend, src_alpha_one, BlendFactor::src_alpha, BlendFactor::one);
BENCHMARK_CAPTURE(blend, src_alpha_inv_src_alpha, BlendFactor::src_alpha, BlendFactor::inv_src_alpha);

}  // namespace
}  // namespace splatscope::output
