#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/isa/program.h"

// Programs as Direct3D shader-model-1 DWORDs and as text. A program's tokens say all that the program says
// but its name and places, so text -> tokens -> text -> tokens ends where it began.
namespace splatscope::isa {

std::vector<std::uint32_t> write_tokens(const Program& program);

// Any DWORDs: what is no shader-model-1 stream is a UserError "name:line:column: ...", where line is the line
// of the disassembly at which the stream went wrong and column 1. Comment tokens are skipped. The rules of
// the version are not checked (validate.h).
Program read_tokens(std::span<const std::uint32_t> tokens, std::string_view name);

// One line a token of the program: version, def, dcl, instructions. In lower case but for oPos, oD0, ...
std::string disassemble(const Program& program);
std::string disassemble(const Program& program, const Instruction& instruction);  // one line, without its end

// Files of tokens: little-endian DWORDs. Throws UserError where the size is no multiple of 4.
std::vector<std::uint32_t> tokens_of_bytes(std::span<const std::byte> bytes, std::string_view name);
std::vector<std::byte> bytes_of_tokens(std::span<const std::uint32_t> tokens);

// Whether a file's bytes begin as a token stream does, not as text.
bool looks_like_tokens(std::span<const std::byte> bytes);

}  // namespace splatscope::isa
