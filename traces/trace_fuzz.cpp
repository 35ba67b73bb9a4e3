// Any bytes: an error or a trace that can be drawn, never a crash. Run: tests/fuzz/README.md.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/error.h"
#include "model/render.h"
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
  const std::vector<std::uint8_t> bytes(data, data + size);  // aligned
  try {
    const Trace trace = traces::trace_of_bytes(bytes, "fuzz");
    if (is_small(trace)) render(trace, {});
  } catch (const UserError&) {
  }
  return 0;
}
