#pragma once

#include <cstdint>

#include "sim/kernel/cycle.h"

namespace splatscope::sim {

// What of a run a log shows: core cycles, and no more text than this.
struct LogWindow {
  Cycle first = 0, last = kNever;
  std::uint64_t most_bytes = 48'000'000;
};

}  // namespace splatscope::sim
