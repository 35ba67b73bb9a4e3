#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "model/number/formats.h"

// Programs on given registers: `splatscope shader run --batch`.
namespace splatscope::studies {

// One case, a JSON object, to one result, a JSON object on one line (docs: COMMANDS, `shader run`). A program
// that does not load gives {"id", "error": "line: column n: rule"}; a case that is no case throws UserError
// at `file`:`line`.
std::string run_shader_case(std::string_view text, Arithmetic arithmetic, std::string_view file, int line);

// A line in, a line out; empty lines are skipped.
void run_shader_batch(std::istream& cases, std::string_view file, Arithmetic arithmetic,
                      std::ostream& results);

}  // namespace splatscope::studies
