#include "studies/own_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "model/command/load_program.h"
#include "model/error.h"
#include "model/input_file.h"
#include "model/isa/tokens.h"
#include "model/isa/validate.h"
#include "studies/shader_report.h"
#include "traces/trace_file.h"

namespace splatscope::studies {

namespace {

// NAME=FILE, where NAME is the program at `place` in the trace.
struct Replacement {
  std::size_t place;
  std::string file;
};

Replacement replacement_of(const Trace& trace, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  std::string names;
  for (const ShaderText& program : trace.programs) names += (names.empty() ? "" : ", ") + program.name;
  if (equals == std::string::npos || equals + 1 == assignment.size()) {
    throw UserError("--program", 0,
                    fmt::format("\"{}\", expected NAME=FILE, where NAME is one of {}", assignment, names));
  }
  const std::string name = assignment.substr(0, equals);
  const auto found = std::ranges::find(trace.programs, name, &ShaderText::name);
  if (found == trace.programs.end())
    throw UserError("--program", 0, fmt::format("no program \"{}\", expected one of {}", name, names));
  return {static_cast<std::size_t>(found - trace.programs.begin()), assignment.substr(equals + 1)};
}

std::string_view kind_of(const isa::Program& program) {
  return program.version.kind == isa::ShaderKind::vertex ? "vertex" : "pixel";
}

// Puts the program of `file` into the place of `replaced`; tokens become text, which is what a trace holds.
// Returns what it did.
std::string replace(ShaderText& replaced, const std::string& file) {
  const isa::Program before = load_program(replaced);
  std::string content = read_text_file(file, "a program as text or tokens");
  const auto bytes = std::as_bytes(std::span(content));
  const isa::Program program = shader_of_bytes(bytes, file);
  if (program.version.kind != before.version.kind) {
    throw UserError(file, 0,
                    fmt::format("a {} program, expected a {} program in the place of {}", kind_of(program),
                                kind_of(before), replaced.name));
  }
  isa::validate(program);
  std::string said = fmt::format("program {} replaced by {} ({} slots, was {})", replaced.name, file,
                                 isa::slot_count(program), isa::slot_count(before));
  replaced = {file, isa::looks_like_tokens(bytes) ? isa::disassemble(program) : content};
  return said;
}

}  // namespace

std::vector<std::string> replace_programs(Trace& trace, const std::vector<std::string>& assignments) {
  std::vector<Replacement> replacements;
  for (const std::string& assignment : assignments) {
    const Replacement next = replacement_of(trace, assignment);
    if (std::ranges::find(replacements, next.place, &Replacement::place) != replacements.end()) {
      throw UserError(
          "--program", 0,
          fmt::format("\"{}\" is given twice, expected one file for it", trace.programs[next.place].name));
    }
    replacements.push_back(next);
  }
  std::vector<std::string> said;
  for (const auto& [place, file] : replacements) {
    said.push_back(replace(trace.programs[place], file));
    traces::check_trace(trace, file);
  }
  return said;
}

}  // namespace splatscope::studies
