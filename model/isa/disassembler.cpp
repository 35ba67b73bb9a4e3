#include <fmt/format.h>

#include <array>

#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/tokens.h"

namespace splatscope::isa {
namespace {

// Positions in vertex programs and for the texture coordinates that t# holds in ps_1_4, colours elsewhere.
std::string_view letters_of(const Program& program, RegisterFile file) {
  const Version& version = program.version;
  const bool coordinates = file == RegisterFile::texture && version.minor == 4;
  return version.kind == ShaderKind::pixel && !coordinates ? "rgba" : "xyzw";
}

std::string text_of(const Program& program, const Destination& destination) {
  std::string text = register_name(destination.file, destination.index);
  if (destination.mask == 0xf) return text;
  text += '.';
  for (std::size_t i = 0; i < 4; ++i)
    if (destination.mask & (1u << i)) text += letters_of(program, destination.file)[i];
  return text;
}

std::string swizzle_text(std::array<std::uint8_t, 4> swizzle, std::string_view letters) {
  if (swizzle == std::array<std::uint8_t, 4>{0, 1, 2, 3}) return "";
  std::size_t length = 4;  // the last letter repeats
  while (length > 1 && swizzle[length - 2] == swizzle[length - 1]) --length;
  std::string text = ".";
  for (std::size_t i = 0; i < length; ++i) text += letters[swizzle[i]];
  return text;
}

std::string_view suffix_of(SourceModifier modifier) {
  switch (modifier) {
    case SourceModifier::bias:
      return "_bias";
    case SourceModifier::bx2:
      return "_bx2";
    case SourceModifier::x2:
      return "_x2";
    case SourceModifier::dz:
      return "_dz";
    case SourceModifier::dw:
      return "_dw";
    default:
      return "";
  }
}

std::string text_of(const Program& program, const Source& source) {
  std::string text = source.negate ? "-" : "";
  if (source.modifier == SourceModifier::invert) text += "1 - ";
  text +=
      source.relative ? fmt::format("c[a0.x + {}]", source.index) : register_name(source.file, source.index);
  text += suffix_of(source.modifier);
  return text + swizzle_text(source.swizzle, letters_of(program, source.file));
}

std::string mnemonic(const Instruction& instruction, std::string_view name) {
  std::string text(name);
  const std::int8_t shift = instruction.destination.shift;
  if (shift != 0) text += fmt::format("_{}{}", shift > 0 ? 'x' : 'd', 1 << std::abs(shift));
  return instruction.destination.saturate ? text + "_sat" : text;
}

}  // namespace

std::string disassemble(const Program& program, const Instruction& instruction) {
  const OpcodeInfo* info = find_opcode(program.version, instruction.opcode);
  if (info == nullptr) return "?";
  // No sums of strings: linked as one, GCC 12 takes these for overflows.
  std::string text = fmt::format("{}{}", instruction.coissue ? "+ " : "", mnemonic(instruction, info->name));
  if (info->has_destination) text += fmt::format(" {}", text_of(program, instruction.destination));
  for (std::size_t i = 0; i < instruction.source_count; ++i)
    text += fmt::format("{}{}", i > 0 || info->has_destination ? ", " : " ",
                        text_of(program, instruction.sources[i]));
  return text;
}

std::string disassemble(const Program& program) {
  std::string text = to_string(program.version) + '\n';
  auto declaration = program.declarations.begin();
  auto definition = program.definitions.begin();
  for (std::size_t place = 0; place <= program.instructions.size(); ++place) {
    for (; declaration != program.declarations.end() && declaration->before == place; ++declaration) {
      const std::string index = declaration->usage_index == 0 ? "" : std::to_string(declaration->usage_index);
      text += fmt::format("dcl_{}{} {}\n", usage_name(declaration->usage), index,
                          text_of(program, declaration->destination));
    }
    for (; definition != program.definitions.end() && definition->before == place; ++definition)
      text += fmt::format("def c{}, {}\n", definition->index, fmt::join(definition->values, ", "));
    if (place < program.instructions.size()) text += disassemble(program, program.instructions[place]) + '\n';
  }
  return text;
}

}  // namespace splatscope::isa
