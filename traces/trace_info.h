#pragma once

#include <string>

#include "traces/trace_file.h"

namespace splatscope::traces {

// What a trace holds, as text for people: sizes, programs, and a line a command.
std::string describe(const Trace& trace);

}  // namespace splatscope::traces
