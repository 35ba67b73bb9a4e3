#pragma once

#include <string>

#include "model/command/commands.h"

namespace splatscope::studies {

// `assignment` is NAME=FILE: the program of that name in the trace becomes the text of the file. What the
// host recorded for it (vertices, constants, weights) stays. Throws UserError (file "--program") where there
// is no such program or it is no assignment, and, with file and line, where the new one cannot be read,
// breaks a rule, or does not fit the draws that use it.
void replace_program(Trace& trace, const std::string& assignment);

}  // namespace splatscope::studies
