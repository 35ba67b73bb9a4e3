#include <benchmark/benchmark.h>

#include <fstream>
#include <random>
#include <sstream>

#include "model/vertex/vertex_program.h"

namespace splatscope::vertex {
namespace {

// The 78-slot program over 262,144 vertices (64k surfels, four vertices each); prints ns per vertex and
// instruction.
void run_splat_ewa(benchmark::State& state, Arithmetic arithmetic) {
  std::ifstream file(SPLATSCOPE_SOURCE "/kernels/object_space_ewa/splat_ewa.vs");
  std::stringstream text;
  text << file.rdbuf();
  const isa::Program source = isa::load(text.str(), "splat_ewa.vs");
  const VertexProgram program(source, arithmetic);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(0.5f, 2.0f);
  std::vector<Vec4> constants(96);
  for (Vec4& constant : constants)
    for (float& component : constant) component = value(random);
  VertexProgram::Bound bound(program, constants);
  for (auto& input : bound.input().v)
    for (auto& component : input)
      for (float& lane : component) lane = value(random);
  constexpr int kVertices = 262144;
  for (auto _ : state)
    for (int first = 0; first < kVertices; first += kBatch) {
      bound.run(kBatch);
      benchmark::DoNotOptimize(bound.output().o[oPos][0][0]);
    }
  const double instructions = static_cast<double>(state.iterations()) * kVertices * isa::slot_count(source);
  state.counters["per_vertex_instruction"] =
      benchmark::Counter(instructions, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(run_splat_ewa, ieee, Arithmetic::ieee)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_splat_ewa, nv20, Arithmetic::nv20)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace splatscope::vertex
