// compare_llvmpipe [ROUNDS]: Table 1's frame of 65,536 EWA surfels, both passes, on this model and on Mesa's
// software renderer, one thread each, one after the other in every round. Prints JSON: milliseconds of
// processor time a frame, the ratio within a round (medians over the rounds), and how far the pictures
// differ.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <span>
#include <vector>

#include "model/machine/machine.h"
#include "model/render.h"
#include "tests/llvmpipe/gl_renderer.h"
#include "traces/median.h"
#include "traces/recorder.h"
#include "traces/scene.h"

namespace splatscope::llvmpipe {
namespace {

// Of the whole process: all threads.
double milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

template <typename Run>
double time_of(Run run) {
  const double start = milliseconds();
  run();
  return milliseconds() - start;
}

// Mean absolute difference of a channel, in steps of 1/255.
double difference(const Frame& frame, const std::vector<std::uint8_t>& pixels) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) sum += std::abs(frame.colors8[i / 4][i % 4] - pixels[i]);
  return sum / static_cast<double>(pixels.size());
}

void compare(int rounds) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Machine machine = machine::load("geforce4-ti4400");
  const Trace trace =
      traces::record(traces::load_scene("checkerboard-ewa-per-surfel"), machine.numbers, {}).trace;
  const RenderOptions options = render_options(machine, Record::nothing);
  const GlRenderer mesa(trace);
  Rendered rendered = render(trace, options);  // both once before it counts
  mesa.draw();
  std::vector<double> ours, theirs, ratios;
  for (int round = 0; round < rounds; ++round) {
    ours.push_back(time_of([&] { rendered = render(trace, options); }));
    theirs.push_back(time_of([&] { mesa.draw(); }));
    ratios.push_back(theirs.back() / ours.back());
  }
  fmt::print(
      "{{\"renderer\": \"{}\", \"rounds\": {},\n \"splatscope_ms\": {:.1f}, \"renderer_ms\": {:.1f}, "
      "\"ratio\": {:.2f},\n \"mean_difference_in_steps\": {:.2f}}}\n",
      mesa.name(), rounds, traces::median(std::span(ours)), traces::median(std::span(theirs)),
      traces::median(std::span(ratios)), difference(rendered.frame, mesa.read()));
}

}  // namespace
}  // namespace splatscope::llvmpipe

int main(int count, char** arguments) {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LP_NUM_THREADS", "1", 0);
  try {
    splatscope::llvmpipe::compare(count > 1 ? std::max(1, std::stoi(arguments[1])) : 21);
  } catch (const std::exception& error) {
    fmt::print(stderr, "compare_llvmpipe: {}\n", error.what());
    return 1;
  }
}
