#pragma once

#include <array>
#include <string_view>

#include "model/isa/program.h"

// What the validators of vertex and pixel programs share. Internal to model/isa.
namespace splatscope::isa {

// Throws UserError at the instruction's place.
[[noreturn]] void reject(const Program& program, const Instruction& at, std::string_view rule);

// The swizzle of a source that names none.
inline constexpr std::array<std::uint8_t, 4> kIdentity{0, 1, 2, 3};
// Whether all four components of its swizzle are the same one.
bool is_replicated(const Source& source);

// The components of each temporary that something has written so far (bit 0 = x).
using WrittenComponents = std::array<unsigned, 16>;

// Rejects two different registers of `file` (read through one port) beyond `ports` in one instruction.
void check_read_ports(const Program& program, const Instruction& instruction, RegisterFile file, int ports);

void validate_vertex(const Program& program);
void validate_pixel(const Program& program);

}  // namespace splatscope::isa
