// Any bytes: an error or a trace that can be drawn and timed, never a crash. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/error.h"
#include "model/machine/machine.h"
#include "model/render.h"
#include "sim/fidelity/sampled.h"
#include "sim/fidelity/throughput.h"
#include "sim/simulate.h"
#include "traces/trace_file.h"

namespace {

// A few triangles on a small frame: others take longer than they tell.
bool is_small(const splatscope::Trace& trace) {
  std::size_t indices = 0;
  for (const splatscope::Command& command : trace.commands) {
    if (const auto* draw = std::get_if<splatscope::Draw>(&command)) indices += draw->index_count;
  }
  return trace.width * trace.height <= 64 * 64 && trace.commands.size() <= 16 && indices <= 300;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace splatscope;
  static const Machine machine = machine::load(machine::kRadeon8500);
  const std::vector<std::uint8_t> bytes(data, data + size);  // aligned
  try {
    const Trace trace = traces::trace_of_bytes(bytes, "fuzz");
    if (!is_small(trace)) return 0;
    const Rendered rendered = render(trace, render_options(machine));
    sim::simulate(trace, rendered.work, machine);
    sim::estimate_throughput(trace, rendered.work, machine);
    sim::estimate_sampled(trace, rendered.work, machine);
  } catch (const UserError&) {
  }
  return 0;
}
