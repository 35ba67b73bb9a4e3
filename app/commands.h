#pragma once

#include <CLI/CLI.hpp>

namespace splatscope::app {

// What all commands share.
struct Invocation {
  bool quiet = false;  // no progress bar
};

// Each command adds itself to the program's command line: its options, its help with an example, and what it
// calls. A command has no logic of its own. It reports bad input by throwing UserError.
void add_explain_command(CLI::App& app, Invocation& invocation);
void add_machine_command(CLI::App& app);
void add_record_command(CLI::App& app, Invocation& invocation);
void add_reproduce_command(CLI::App& app, Invocation& invocation);
void add_run_command(CLI::App& app, Invocation& invocation);
void add_sample_command(CLI::App& app, Invocation& invocation);
void add_scene_command(CLI::App& app);
void add_shader_command(CLI::App& app);
void add_study_command(CLI::App& app, Invocation& invocation);
void add_sweep_command(CLI::App& app, Invocation& invocation);
void add_trace_command(CLI::App& app);
void add_volume_command(CLI::App& app, Invocation& invocation);

}  // namespace splatscope::app
