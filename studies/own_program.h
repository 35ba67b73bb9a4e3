#pragma once

#include <string>
#include <vector>

#include "model/command/commands.h"

namespace splatscope::studies {

// An assignment is NAME=FILE: the program of that name in the trace becomes that of the file, text or tokens.
// What the host recorded for it (vertices, constants, weights) stays. Throws UserError (file "--program")
// where there is no such program, one is given twice, or it is no assignment, and, with file and line, where
// the new one cannot be read, is of the other kind, breaks a rule, or does not fit the draws that use it.
// Returns a line for people on each.
std::vector<std::string> replace_programs(Trace& trace, const std::vector<std::string>& assignments);

}  // namespace splatscope::studies
