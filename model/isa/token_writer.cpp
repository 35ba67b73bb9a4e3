#include <algorithm>
#include <bit>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/token_layout.h"
#include "model/isa/tokens.h"

namespace splatscope::isa {
namespace {

std::uint32_t register_token(RegisterFile file, std::uint32_t index) {
  const RegisterType type = register_type(file, index);
  return kParameterBit | type.type << 28 | type.index;
}

std::uint32_t token_of(const Destination& destination) {
  std::uint32_t token = register_token(destination.file, destination.index);
  const bool one = is_scalar_output(destination.file) && std::has_single_bit(destination.mask);
  const std::uint32_t mask = one ? 0xfu : destination.mask;
  token |= mask << 16;
  token |= (static_cast<std::uint32_t>(destination.shift) & 0xf) << 24;
  return destination.saturate ? token | kSaturateBit : token;
}

std::uint32_t token_of(const Source& source) {
  std::uint32_t token = register_token(source.file, source.index);
  if (source.relative) token |= kRelativeBit;
  for (std::uint32_t lane = 0; lane < 4; ++lane)
    token |= std::uint32_t{source.swizzle[lane]} << (16 + 2 * lane);
  const auto code = std::ranges::find_if(kSourceModifiers, [&](const SourceModifierCode& row) {
    return row.modifier == source.modifier && row.negate == source.negate;
  });
  if (code == kSourceModifiers.end()) throw ModelError("a source modifier that has no token");
  return token | static_cast<std::uint32_t>(code - kSourceModifiers.begin()) << 24;
}

}  // namespace

std::vector<std::uint32_t> write_tokens(const Program& program) {
  const Version version = program.version;
  std::vector<std::uint32_t> tokens;
  tokens.push_back((version.kind == ShaderKind::vertex ? kVertexVersion : kPixelVersion) |
                   static_cast<std::uint32_t>(version.major << 8 | version.minor));
  auto declaration = program.declarations.begin();
  auto definition = program.definitions.begin();
  for (std::size_t place = 0; place <= program.instructions.size(); ++place) {
    for (; declaration != program.declarations.end() && declaration->before == place; ++declaration) {
      tokens.push_back(kDeclarationOpcode);
      tokens.push_back(kParameterBit | std::uint32_t{declaration->usage_index} << 16 | declaration->usage);
      tokens.push_back(token_of(declaration->destination));
    }
    for (; definition != program.definitions.end() && definition->before == place; ++definition) {
      tokens.push_back(kDefinitionOpcode);
      tokens.push_back(token_of(Destination{RegisterFile::constant, definition->index}));
      for (const float value : definition->values) tokens.push_back(std::bit_cast<std::uint32_t>(value));
    }
    if (place == program.instructions.size()) break;
    const Instruction& instruction = program.instructions[place];
    const OpcodeInfo* info = find_opcode(version, instruction.opcode);
    if (info == nullptr) throw ModelError("an instruction that its version does not have");
    tokens.push_back(info->token | (instruction.coissue ? kCoissueBit : 0u));
    if (info->has_destination) tokens.push_back(token_of(instruction.destination));
    for (const Source& source : instruction.used_sources()) tokens.push_back(token_of(source));
  }
  tokens.push_back(kEndToken);
  return tokens;
}

std::vector<std::byte> bytes_of_tokens(std::span<const std::uint32_t> tokens) {
  std::vector<std::byte> bytes;
  for (const std::uint32_t token : tokens)
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::byte>(token >> shift & 0xff));
  return bytes;
}

}  // namespace splatscope::isa
