#include "studies/shader_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "model/error.h"
#include "model/isa/analysis.h"
#include "model/isa/opcode.h"
#include "model/isa/tokens.h"
#include "model/machine/machine.h"
#include "sim/draw_jobs.h"
#include "sim/units/vertex/schedule.h"

namespace splatscope::studies {
namespace {

// Which instructions issue in each slot of a vertex unit, and how long each slot waits in a full group of
// vertices.
struct Issue {
  std::vector<std::size_t> instructions;  // one, or a pair
  int waiting = 0;                        // clocks in which the unit issued nothing and this slot came next
};

std::vector<Issue> issues_of(const isa::Program& program, const Machine::Vertex& spec) {
  const std::vector<sim::IssueSlot> slots = sim::issue_slots(program, spec);
  std::vector<Issue> issues(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (const int place : slots[i].instructions) {
      if (place >= 0) issues[i].instructions.push_back(static_cast<std::size_t>(place));
    }
  }
  sim::IssueLogic logic(slots, spec);
  logic.start(spec.threads);
  std::vector<std::size_t> next(static_cast<std::size_t>(spec.threads));
  for (int waiting = 0; !logic.done();) {
    const int thread = logic.issue();
    if (thread < 0) {
      ++waiting;
      continue;
    }
    issues[next[static_cast<std::size_t>(thread)]++].waiting += waiting;
    waiting = 0;
  }
  return issues;
}

std::string describe_on_machine(const isa::Program& program, const Machine& machine) {
  const std::vector<Issue> issues = issues_of(program, machine.vertex);
  std::string pairs, waits;
  const auto line = [&](std::size_t instruction) { return program.instructions[instruction].line; };
  for (const Issue& issue : issues) {
    if (issue.instructions.size() == 2)
      pairs += fmt::format(" {}+{}", line(issue.instructions[0]), line(issue.instructions[1]));
    if (issue.waiting > 0) waits += fmt::format(" {} ({})", line(issue.instructions[0]), issue.waiting);
  }
  std::string text =
      fmt::format("{}: {:.2f} clocks a vertex in each of {} units, {} issues\n", machine.name,
                  sim::clocks_per_vertex(program, machine.vertex), machine.vertex.units, issues.size());
  if (!pairs.empty()) text += fmt::format("  pairs, by line:{}\n", pairs);
  if (!waits.empty())
    text += fmt::format("  waits, by line (clocks of a group of {} vertices):{}\n", machine.vertex.threads,
                        waits);
  return text;
}

}  // namespace

isa::Program shader_of_bytes(std::span<const std::byte> bytes, std::string_view name) {
  if (isa::looks_like_tokens(bytes)) return isa::read_tokens(isa::tokens_of_bytes(bytes, name), name);
  return isa::assemble({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
}

isa::Program read_shader(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw UserError(file, 0, "cannot be read, expected a shader as text or tokens");
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return shader_of_bytes(std::as_bytes(std::span(content)), file);
}

std::string describe_shader(const isa::Program& program) {
  const isa::Analysis analysis = isa::analyze(program);
  const auto dead = std::ranges::count_if(analysis.instructions, &isa::InstructionAnalysis::dead);
  std::string text = fmt::format("{}: {}, {} slots, at most {} temporaries live, {} dead instructions\n",
                                 program.name, isa::to_string(program.version), isa::slot_count(program),
                                 analysis.most_live_temporaries, dead);
  text += fmt::format("critical path: {} slots, by line:", analysis.critical_slots);
  for (const std::size_t place : analysis.critical_path)
    text += fmt::format(" {}", program.instructions[place].line);
  text += '\n';
  for (const std::string_view name : machine::built_in_names()) {
    const Machine machine = machine::load(std::string(name));
    text += program.version.kind == isa::ShaderKind::vertex
                ? describe_on_machine(program, machine)
                : fmt::format("{}: {} clocks a quad in the pixel unit\n", machine.name,
                              sim::clocks_per_quad(program, machine.pixel));
  }
  text += fmt::format("\n{:>4} {:>5}  {:<44} {}\n", "line", "slots", "instruction", "live after");
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    const isa::Instruction& instruction = program.instructions[i];
    const isa::InstructionAnalysis& facts = analysis.instructions[i];
    const int slots = instruction.coissue ? 0 : isa::find_opcode(program.version, instruction.opcode)->slots;
    text += fmt::format("{:>4} {:>5}  {:<44} {}{}\n", instruction.line, slots,
                        isa::disassemble(program, instruction), isa::to_string(facts.live_after),
                        facts.dead ? "  dead" : "");
  }
  return text;
}

}  // namespace splatscope::studies
