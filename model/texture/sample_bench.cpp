#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <vector>

#include "model/texture/sample.h"

namespace splatscope::texture {
namespace {

constexpr std::size_t kFragments = 64;

// With and without the numbers of the texel blocks, which only the work record needs.
void sample(benchmark::State& state, bool with_blocks) {
  const Texture texture{438, 438, std::vector<std::uint8_t>(438 * 438, 100)};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0, 1);
  alignas(64) std::array<float, kFragments> u, v, alpha;
  for (float& value : u) value = place(random);
  for (float& value : v) value = place(random);
  std::array<std::uint32_t, kFragments> blocks;
  const auto noted = std::span(blocks).first(with_blocks ? kFragments : 0);
  for (auto _ : state) {
    sample_nearest(texture, u.data(), v.data(), alpha, noted);
    benchmark::DoNotOptimize(alpha.data());
  }
  state.counters["samples"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kFragments, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(sample, alpha, false);
BENCHMARK_CAPTURE(sample, alpha_and_blocks, true);

}  // namespace
}  // namespace splatscope::texture
