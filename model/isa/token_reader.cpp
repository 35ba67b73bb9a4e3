#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <utility>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/register_names.h"
#include "model/isa/token_layout.h"
#include "model/isa/tokens.h"

namespace splatscope::isa {
namespace {

class TokenReader {
 public:
  TokenReader(std::span<const std::uint32_t> tokens, std::string_view name) : tokens_(tokens) {
    program_.name = name;
  }

  Program read() {
    read_version();
    for (std::uint32_t token = next("an end token (0000ffff)"); token != kEndToken;
         token = next("an end token (0000ffff)"))
      read_statement(token);
    if (position_ != tokens_.size()) fail("tokens follow the end token");
    return std::move(program_);
  }

 private:
  [[noreturn]] void fail(std::string_view message) const {
    throw UserError(program_.name, line_, 1,
                    fmt::format("{} (token {})", message, position_ == 0 ? 0 : position_ - 1));
  }

  std::uint32_t next(std::string_view expected) {
    if (position_ == tokens_.size()) fail(fmt::format("the tokens end, expected {}", expected));
    return tokens_[position_++];
  }

  void read_version() {
    const std::uint32_t token = next("a version");
    const std::uint32_t minor = token & 0xff;
    if (token == (kVertexVersion | 0x101u))
      program_.version = {ShaderKind::vertex, 1, 1};
    else if ((token & 0xffffff00u) == (kPixelVersion | 0x100u) && minor >= 1 && minor <= 4)
      program_.version = {ShaderKind::pixel, 1, static_cast<int>(minor)};
    else
      fail(fmt::format(
          "{:08x} is not a version, expected vs_1_1 (fffe0101) or ps_1_1 to ps_1_4 (ffff0101 to ffff0104)",
          token));
  }

  void read_statement(std::uint32_t token) {
    const std::uint32_t opcode = token & 0xffff;
    if (opcode == kCommentOpcode) return skip_comment(token);
    ++line_;
    if (opcode == kDefinitionOpcode) return read_definition(token);
    if (opcode == kDeclarationOpcode && program_.version.kind == ShaderKind::vertex)
      return read_declaration(token);
    const OpcodeInfo* info = find_opcode(program_.version, static_cast<std::uint16_t>(opcode));
    if (info == nullptr || (token & ~(0xffffu | kCoissueBit)) != 0)
      fail(fmt::format("{:08x} is not an instruction of {}", token, to_string(program_.version)));
    Instruction instruction;
    instruction.opcode = info->opcode;
    instruction.line = line_;
    instruction.column = 1;
    instruction.coissue = (token & kCoissueBit) != 0;
    instruction.source_count = info->source_count;
    if (info->has_destination) instruction.destination = read_destination();
    for (std::size_t i = 0; i < info->source_count; ++i) instruction.sources[i] = read_source();
    program_.instructions.push_back(instruction);
  }

  void skip_comment(std::uint32_t token) {
    const std::size_t length = token >> 16 & 0x7fff;
    if (token >> 31 != 0 || length > tokens_.size() - position_)
      fail("a comment goes past the end of the tokens");
    position_ += length;
  }

  void read_definition(std::uint32_t token) {
    if (token != kDefinitionOpcode) fail(fmt::format("{:08x} is not a def", token));
    const Destination destination = read_destination();
    if (destination != Destination{RegisterFile::constant, destination.index})
      fail("def defines a whole constant c#");
    Definition definition;
    definition.index = destination.index;
    for (float& value : definition.values) {
      value = std::bit_cast<float>(next("a value of def"));
      if (!std::isfinite(value)) fail("def defines finite values");
    }
    definition.before = program_.instructions.size();
    definition.line = line_;
    definition.column = 1;
    program_.definitions.push_back(definition);
  }

  void read_declaration(std::uint32_t token) {
    if (token != kDeclarationOpcode) fail(fmt::format("{:08x} is not a dcl", token));
    const std::uint32_t usage = next("the usage of dcl");
    if ((usage & ~(0xf000fu | kParameterBit)) != 0 || !(usage & kParameterBit) ||
        usage_name(static_cast<int>(usage & 0xf)).empty())
      fail(fmt::format("{:08x} is not a usage of dcl", usage));
    Declaration declaration;
    declaration.usage = static_cast<std::uint8_t>(usage & 0xf);
    declaration.usage_index = static_cast<std::uint8_t>(usage >> 16 & 0xf);
    declaration.destination = read_destination();
    if (declaration.destination.file != RegisterFile::input || declaration.destination.shift != 0 ||
        declaration.destination.saturate)
      fail("dcl declares an input v#");
    declaration.before = program_.instructions.size();
    declaration.line = line_;
    declaration.column = 1;
    program_.declarations.push_back(declaration);
  }

  RegisterFile read_file(std::uint32_t token, std::uint32_t unknown_bits) const {
    const auto file = register_file(program_.version.kind, token >> 28 & 0x7, token & kMaximumIndex);
    if (!(token & kParameterBit) || (token & unknown_bits) != 0 || !file)
      fail(fmt::format("{:08x} is not a register of {}", token, to_string(program_.version)));
    return *file;
  }

  static std::uint16_t index_of(RegisterFile file, std::uint32_t token) {
    const bool numbered = register_type(file, 1).index == 1 && file != RegisterFile::fog_out;
    return numbered ? static_cast<std::uint16_t>(token & kMaximumIndex) : std::uint16_t{0};
  }

  Destination read_destination() {
    const std::uint32_t token = next("a destination");
    Destination destination;
    destination.file = read_file(token, 0x00e0f800u);
    destination.index = index_of(destination.file, token);
    destination.mask = static_cast<std::uint8_t>(token >> 16 & 0xf);
    if (destination.mask == 0) fail("the write mask is empty");
    destination.saturate = (token & kSaturateBit) != 0;
    const auto shift = static_cast<int>(token >> 24 & 0xf);
    destination.shift = static_cast<std::int8_t>(shift >= 8 ? shift - 16 : shift);
    if (destination.shift < -3 || destination.shift > 3) fail("a destination is shifted by at most 3 bits");
    return destination;
  }

  Source read_source() {
    const std::uint32_t token = next("a source");
    Source source;
    source.file = read_file(token, 0x0000d800u);
    source.index = index_of(source.file, token);
    source.relative = (token & kRelativeBit) != 0;
    if (source.relative &&
        (source.file != RegisterFile::constant || program_.version.kind != ShaderKind::vertex))
      fail("only c# of a vertex program can be addressed relative to a0.x");
    for (std::uint32_t lane = 0; lane < 4; ++lane)
      source.swizzle[lane] = static_cast<std::uint8_t>(token >> (16 + 2 * lane) & 0x3);
    const std::size_t code = token >> 24 & 0xf;
    if (code >= kSourceModifiers.size() || (code > 1 && program_.version.kind == ShaderKind::vertex))
      fail(fmt::format("{:08x} has a source modifier that {} does not know", token,
                       to_string(program_.version)));
    source.modifier = kSourceModifiers[code].modifier;
    source.negate = kSourceModifiers[code].negate;
    return source;
  }

  std::span<const std::uint32_t> tokens_;
  std::size_t position_ = 0;
  int line_ = 1;  // of the disassembly
  Program program_;
};

}  // namespace

Program read_tokens(std::span<const std::uint32_t> tokens, std::string_view name) {
  return TokenReader(tokens, name).read();
}

std::vector<std::uint32_t> tokens_of_bytes(std::span<const std::byte> bytes, std::string_view name) {
  if (bytes.size() % 4 != 0)
    throw UserError(name, 0,
                    fmt::format("{} bytes are not whole tokens, expected a multiple of 4", bytes.size()));
  std::vector<std::uint32_t> tokens(bytes.size() / 4);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    tokens[i / 4] |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * (i % 4));
  return tokens;
}

bool looks_like_tokens(std::span<const std::byte> bytes) {
  // The version token's upper half: no text has these bytes in its third and fourth place.
  return bytes.size() >= 4 && (bytes[2] == std::byte{0xfe} || bytes[2] == std::byte{0xff}) &&
         bytes[3] == std::byte{0xff};
}

}  // namespace splatscope::isa
