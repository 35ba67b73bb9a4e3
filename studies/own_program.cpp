#include "studies/own_program.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.h"
#include "model/input_file.h"
#include "traces/trace_file.h"

namespace splatscope::studies {

void replace_program(Trace& trace, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  std::string names;
  for (const ShaderText& program : trace.programs) names += (names.empty() ? "" : ", ") + program.name;
  if (equals == std::string::npos) {
    throw UserError("--program", 0,
                    fmt::format("\"{}\", expected NAME=FILE, where NAME is one of {}", assignment, names));
  }
  const std::string name = assignment.substr(0, equals), file = assignment.substr(equals + 1);
  const auto found = std::ranges::find(trace.programs, name, &ShaderText::name);
  if (found == trace.programs.end())
    throw UserError("--program", 0, fmt::format("no program \"{}\", expected one of {}", name, names));
  *found = {file, read_text_file(file, "a program's text")};
  traces::check_trace(trace, file);
}

}  // namespace splatscope::studies
