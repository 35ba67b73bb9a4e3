#pragma once

#include <CLI/CLI.hpp>

// Each command adds itself to the program's command line: its options, its help with an example, and what it
// calls. A command has no logic of its own. It reports bad input by throwing UserError, and sets `status` to
// 1 where a comparison did not hold.
namespace splatscope::app {

void add_scene_command(CLI::App& app, int& status);
void add_trace_command(CLI::App& app, int& status);

}  // namespace splatscope::app
