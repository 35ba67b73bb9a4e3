#pragma once

namespace splatscope::app {

// The whole program but for the start of its process: does what the arguments say and returns the exit
// status: 0 done, 1 failed, 2 the input is wrong, 128 + the signal that interrupted it. What went wrong is
// one line on standard error.
int run_command_line(int argc, const char* const* argv);

}  // namespace splatscope::app
