#pragma once

#include <string>
#include <vector>

#include "model/machine/machine.h"

namespace splatscope::app {

// The machine of --machine with the parameters of --set, whose fit is not checked yet. Throws UserError where
// one of these is wrong, or given twice: no one who writes that means the last.
Machine machine_of(const std::string& name, const std::vector<std::string>& settings);

}  // namespace splatscope::app
