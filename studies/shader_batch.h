#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "model/number/formats.h"

// Programs on given registers: `splatscope shader run --batch`.
namespace splatscope::studies {

struct ShaderResult {
  std::string json;  // an object on one line
  bool is_object;    // whether the case was a JSON object, of any content
};

// One case, a JSON object, to one result (docs/shaders.md). What is wrong with it gives {"id", "error":
// "LINE: what"}: LINE is that of the program, or 0 where the case itself is wrong; the id is null where the
// case has none, or none that is text or a number.
ShaderResult run_shader_case(std::string_view text, Arithmetic arithmetic);

// A line in, a line out; empty lines are skipped. Throws UserError at `file` and the first line that was no
// JSON object, after the last line; at the line that cannot be read.
void run_shader_batch(std::istream& cases, std::string_view file, Arithmetic arithmetic,
                      std::ostream& results);

}  // namespace splatscope::studies
