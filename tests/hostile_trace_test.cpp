#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "model/error.h"
#include "model/render.h"
#include "model/testing/random_seed.h"
#include "program.h"
#include "sim/simulate.h"
#include "traces/output_files.h"
#include "traces/recorder.h"
#include "traces/trace_file.h"

// Whatever read_trace lets in, the machine draws and times to the end.
namespace splatscope::tests {
namespace {

Trace small_trace(std::string_view algorithm) {
  const traces::Scene scene = traces::parse_scene(
      fmt::format("[surfels]\ncolumns = 4\nrows = 4\n[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n"
                  "[frame]\nwidth = 48\nheight = 32\n[splatting]\nalgorithm = \"{}\"\n",
                  algorithm),
      "small.toml");
  return traces::record(scene, NumberFormats{}).trace;
}

// Changes up to 6 bytes near the file's ends, where everything but texels and vertices lies.
std::string mutant_of(const std::string& whole, std::mt19937& random) {
  constexpr std::size_t kEnds = 4000;
  std::string mutant = whole;
  for (auto changes = 1 + random() % 6; changes > 0; --changes) {
    const std::size_t from_end = random() % kEnds;
    mutant[random() % 2 ? from_end : whole.size() - 1 - from_end] = static_cast<char>(random());
  }
  return mutant;
}

void expect_mutants_harmless(std::string_view algorithm) {
  std::mt19937 random(random_seed());
  const ScratchFolder folder;
  const auto path = folder.path() / "mutant.trace";
  traces::write_trace(small_trace(algorithm), path);
  const std::string whole = text_of(path);
  const Machine machine = machine::load("geforce4-ti4400");
  int drawn = 0;
  for (int i = 0; i < 250; ++i) {
    traces::write_file(path, mutant_of(whole, random));
    try {
      const Trace trace = traces::read_trace(path);
      if (trace.width * trace.height > 256 * 256) continue;  // valid, and slow
      const Rendered rendered = render(trace, {});
      EXPECT_GT(sim::simulate(trace, rendered.work, machine).cycles, 0u);
      ++drawn;
    } catch (const UserError&) {
    }
  }
  EXPECT_GT(drawn, 20) << "too few mutants were let in to tell anything";
}

TEST(HostileTrace, OfPlainSplatting) {
  expect_mutants_harmless("no-ewa");
}
TEST(HostileTrace, OfNormalisationPerPixel) {
  expect_mutants_harmless("ewa-per-pixel");
}
TEST(HostileTrace, OfNormalisationPerSurfel) {
  expect_mutants_harmless("ewa-per-surfel");
}

}  // namespace
}  // namespace splatscope::tests
