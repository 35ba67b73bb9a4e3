#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "model/machine/machine.h"
#include "traces/output_files.h"

namespace splatscope::app {

// What the commands that run an input on a machine have in common: --machine, --set and --program.
struct MachineOptions {
  std::string name{machine::kGeForce4};
  std::vector<std::string> settings;  // KEY=VALUE
  std::vector<std::string> programs;  // NAME=FILE

  void add_to(CLI::App& command);

  // Whose fit is not checked yet. Throws UserError where an option is wrong, or given twice: no one who
  // writes that means the last.
  Machine machine() const;

  // What a command that runs `input` reads by its command line alone.
  std::vector<traces::NamedFile> files_with(const std::string& input) const;
};

// --seed, of commands with --fidelity.
void add_seed_option(CLI::App& command, std::uint64_t& seed);

}  // namespace splatscope::app
