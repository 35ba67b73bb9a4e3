#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Programs of Direct3D 8.1's shader model 1, as data. Text and tokens both come to this form; the validator, the
// executors and the static analysis start from it.
namespace splatscope::isa {

enum class ShaderKind : std::uint8_t { vertex, pixel };

struct Version {
  ShaderKind kind = ShaderKind::vertex;
  int major = 1;
  int minor = 1;
  bool operator==(const Version&) const = default;
};

enum class Opcode : std::uint8_t {
  nop, mov, add, sub, mul, mad, dp3, dp4, min, max, slt, sge, rcp, rsq, expp, logp, lit, dst,
  exp, log, frc, m4x4, m4x3, m3x4, m3x3, m3x2,  // macros: more than one slot each
};

enum class RegisterFile : std::uint8_t { temporary, input, constant, address, position_out, fog_out, point_size_out,
                                         color_out, texcoord_out, texture };

struct Destination {
  RegisterFile file = RegisterFile::temporary;
  std::uint8_t index = 0;
  std::uint8_t mask = 0xf;  // bit 0 = x
};

struct Source {
  RegisterFile file = RegisterFile::temporary;
  std::uint8_t index = 0;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};
  bool negate = false;
  bool relative = false;  // c[a0.x + index]
};

struct Instruction {
  Opcode opcode = Opcode::nop;
  Destination destination;
  std::array<Source, 3> sources;
  int source_count = 0;
  int line = 0;    // of the text, from 1; 0 when it came from tokens
  int column = 0;  // from 1
};

struct Program {
  std::string name;  // file name, for messages
  Version version;
  std::vector<Instruction> instructions;
};

// Text to program, checked against every rule of its version (validate.h).
// Throws UserError "name:line:column: rule" where the text does not assemble or breaks a rule.
Program load(std::string_view text, std::string_view name);

// Instruction slots as Direct3D 8.1 counts them: 1 an instruction, macros at their expansion, def and dcl 0.
int slot_count(const Program& program);

}  // namespace splatscope::isa
