#pragma once

#include <string>
#include <vector>

#include "model/machine/machine.h"
#include "traces/output_files.h"

namespace splatscope::app {

// The machine of --machine with the parameters of --set, whose fit is not checked yet. Throws UserError where
// one of these is wrong, or given twice: no one who writes that means the last.
Machine machine_of(const std::string& name, const std::vector<std::string>& settings);

// What a command that runs `input` reads by its command line alone; `programs`: NAME=FILE.
std::vector<traces::NamedFile> named_files(const std::string& input, const std::string& machine,
                                           const std::vector<std::string>& programs);

}  // namespace splatscope::app
