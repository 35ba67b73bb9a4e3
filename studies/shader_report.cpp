#include "studies/shader_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "model/input_file.h"
#include "model/isa/analysis.h"
#include "model/isa/opcode.h"
#include "model/isa/tokens.h"
#include "model/machine/machine.h"
#include "sim/draw_jobs.h"
#include "sim/units/vertex/vertex_clocks.h"

namespace splatscope::studies {
namespace {

std::string describe_on_machine(const isa::Program& program, const Machine& machine) {
  const std::vector<sim::IssueSlot> slots = sim::issue_slots(program, machine.vertex);
  const sim::Throughput throughput = sim::throughput(slots, machine.vertex);
  std::string pairs, waits;
  const auto line = [&](int place) { return program.instructions[static_cast<std::size_t>(place)].line; };
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto [first, second] = slots[i].instructions;
    if (second >= 0) pairs += fmt::format(" {}+{}", line(first), line(second));
    if (throughput.waits[i] > 0) waits += fmt::format(" {} ({:.2f})", line(first), throughput.waits[i]);
  }
  std::string text = fmt::format("{}: {:.2f} clocks a vertex in each of {} units, {} issues\n", machine.name,
                                 throughput.clocks_per_vertex, machine.vertex.units, slots.size());
  if (!pairs.empty()) text += fmt::format("  pairs, by line:{}\n", pairs);
  if (!waits.empty()) text += fmt::format("  waits, by line (clocks a vertex):{}\n", waits);
  return text;
}

}  // namespace

isa::Program shader_of_bytes(std::span<const std::byte> bytes, std::string_view name) {
  if (isa::looks_like_tokens(bytes)) return isa::read_tokens(isa::tokens_of_bytes(bytes, name), name);
  return isa::assemble({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
}

isa::Program read_shader(const std::string& file) {
  const std::string content = read_text_file(file, "a shader as text or tokens");
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
    const Machine machine = machine::load(name);
    text += program.version.kind == isa::ShaderKind::vertex
                ? describe_on_machine(program, machine)
                : fmt::format("{}: {} clocks a quad in the pixel unit\n", machine.name,
                              sim::clocks_per_quad(program, machine.pixel));
  }
  text += fmt::format("\n{:>4} {:>5}  {:<44} {}\n", "line", "slots", "instruction", "live after");
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    const isa::Instruction& instruction = program.instructions[i];
    const isa::InstructionAnalysis& facts = analysis.instructions[i];
    text += fmt::format("{:>4} {:>5}  {:<44} {}{}\n", instruction.line, isa::slots_at(program, i),
                        isa::disassemble(program, instruction), isa::to_string(facts.live_after),
                        facts.dead ? "  dead" : "");
  }
  return text;
}

}  // namespace splatscope::studies
