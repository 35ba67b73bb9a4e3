#include "studies/own_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "model/error.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw UserError(path, 0, "cannot be read, expected a program's text");
  return text.str();
}

}  // namespace

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
  *found = {file, read_text(file)};
  traces::check_trace(trace, file);
}

}  // namespace splatscope::studies
