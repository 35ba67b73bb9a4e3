#include "model/isa/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/rules.h"

namespace splatscope::isa {

void reject(const Program& program, const Instruction& at, std::string_view rule) {
  throw UserError(program.name, at.line, at.column, rule);
}

namespace {

// Of the operand after its swizzle.
unsigned lanes_read(const Instruction& instruction, std::size_t source) {
  const unsigned mask = instruction.destination.mask;
  switch (instruction.opcode) {
    case Opcode::rcp:
    case Opcode::rsq:
    case Opcode::expp:
    case Opcode::logp:
    case Opcode::exp:
    case Opcode::log:
      return 0x1;
    case Opcode::bem:
    case Opcode::texbem:
      return 0x3;
    case Opcode::texreg2gb:
      return 0x6;
    case Opcode::dp3:
    case Opcode::m3x4:
    case Opcode::m3x3:
    case Opcode::m3x2:
    case Opcode::texm3x2pad:
    case Opcode::texm3x2tex:
    case Opcode::texm3x2depth:
    case Opcode::texm3x3pad:
    case Opcode::texm3x3tex:
    case Opcode::texm3x3spec:
    case Opcode::texm3x3vspec:
    case Opcode::texm3x3:
    case Opcode::texdp3:
    case Opcode::texdp3tex:
    case Opcode::texcrd:
    case Opcode::texld:
    case Opcode::texreg2rgb:
    case Opcode::texbeml:  // the third is the luminance
      return 0x7;
    case Opcode::texreg2ar:
      return 0x9;
    case Opcode::dp4:
    case Opcode::m4x4:
    case Opcode::m4x3:
      return 0xf;
    case Opcode::lit:
      return (mask & 0x2 ? 0x1u : 0u) | (mask & 0x4 ? 0xbu : 0u);
    case Opcode::dst:
      return mask & (source == 0 ? 0x6u : 0xau);
    default:
      return mask;
  }
}

}  // namespace

unsigned components_read(const Instruction& instruction, std::size_t source) {
  const unsigned lanes = lanes_read(instruction, source);
  const auto& swizzle = instruction.sources[source].swizzle;
  unsigned components = 0;
  for (unsigned lane = 0; lane < 4; ++lane)
    if (lanes & (1u << lane)) components |= 1u << swizzle[lane];
  return components;
}

unsigned destination_components_read(Opcode opcode) {
  return opcode == Opcode::texdepth ? 0x3 : opcode == Opcode::texkill ? 0x7 : 0;
}

bool is_replicated(const Source& source) {
  return std::ranges::all_of(source.swizzle, [&](std::uint8_t lane) { return lane == source.swizzle[0]; });
}

void check_read_ports(const Program& program, const Instruction& instruction, RegisterFile file, int ports) {
  std::vector<std::pair<bool, int>> distinct;  // relative or not, index
  for (const Source& source : instruction.used_sources()) {
    const std::pair<bool, int> key{source.relative, source.index};
    if (source.file == file && std::ranges::find(distinct, key) == distinct.end()) distinct.push_back(key);
  }
  if (static_cast<int>(distinct.size()) <= ports) return;
  const std::string name = register_name(file, 0).substr(0, 1) + "#";
  reject(program, instruction,
         fmt::format("{} different {} registers in one instruction, {} has {} read port{}", distinct.size(),
                     name, to_string(program.version), ports, ports == 1 ? "" : "s"));
}

void validate(const Program& program) {
  if (program.instructions.empty())
    throw UserError(program.name, 1, 1, "a program has at least one instruction");
  for (const Instruction& instruction : program.instructions)
    if (find_opcode(program.version, instruction.opcode) == nullptr)
      reject(program, instruction, fmt::format("{} has no such instruction", to_string(program.version)));
  for (const Definition& definition : program.definitions)
    if (definition.before != 0)
      throw UserError(program.name, definition.line, definition.column, "def must precede the instructions");
  for (const Declaration& declaration : program.declarations)
    if (declaration.before != 0)
      throw UserError(program.name, declaration.line, declaration.column,
                      "dcl must precede the instructions");
  program.version.kind == ShaderKind::vertex ? validate_vertex(program) : validate_pixel(program);
}

}  // namespace splatscope::isa
