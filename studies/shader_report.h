#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "model/isa/program.h"

// What `splatscope shader` says of a program.
namespace splatscope::studies {

// A program from a file's bytes: Direct3D tokens where they begin as a token stream, else text. Not
// validated. Throws UserError.
isa::Program shader_of_bytes(std::span<const std::byte> bytes, std::string_view name);
isa::Program read_shader(const std::string& file);

// Slots, live registers, dead instructions and the critical path, a line an instruction; the clocks of a
// vertex or of a quad on each machine; of a vertex program also what pairs and what waits.
std::string describe_shader(const isa::Program& program);

}  // namespace splatscope::studies
