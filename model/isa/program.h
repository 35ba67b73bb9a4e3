#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Programs of Direct3D 8.1's shader model 1, as data. Text and tokens both come to this form; the validator,
// the executors and the static analysis start from it.
namespace splatscope::isa {

enum class ShaderKind : std::uint8_t { vertex, pixel };

struct Version {
  ShaderKind kind = ShaderKind::vertex;
  int major = 1;
  int minor = 1;
  bool operator==(const Version&) const = default;
};

enum class Opcode : std::uint8_t {
  // Vertex programs, and of them the arithmetic that pixel programs share.
  nop,
  mov,
  add,
  sub,
  mul,
  mad,
  dp3,
  dp4,
  min,
  max,
  slt,
  sge,
  rcp,
  rsq,
  expp,
  logp,
  lit,
  dst,
  // Macros: more than one slot each.
  exp,
  log,
  frc,
  m4x4,
  m4x3,
  m3x4,
  m3x3,
  m3x2,
  // Pixel programs: arithmetic.
  lrp,
  cnd,
  cmp,
  bem,
  phase,
  // Texture addressing, ps_1_1 to ps_1_3.
  tex,
  texcoord,
  texkill,
  texbem,
  texbeml,
  texreg2ar,
  texreg2gb,
  texreg2rgb,
  texm3x2pad,
  texm3x2tex,
  texm3x2depth,
  texm3x3pad,
  texm3x3tex,
  texm3x3spec,
  texm3x3vspec,
  texm3x3,
  texdp3,
  texdp3tex,
  // Texture addressing, ps_1_4.
  texld,
  texcrd,
  texdepth,
};

enum class RegisterFile : std::uint8_t {
  temporary,
  input,
  constant,
  address,
  position_out,
  fog_out,
  point_size_out,
  color_out,
  texcoord_out,
  texture
};

// Whose writes name one component, which their tokens do not tell from all four.
constexpr bool is_scalar_output(RegisterFile file) {
  return file == RegisterFile::fog_out || file == RegisterFile::point_size_out;
}

struct Destination {
  RegisterFile file = RegisterFile::temporary;
  std::uint16_t index = 0;
  std::uint8_t mask = 0xf;  // bit 0 = x
  std::int8_t shift = 0;    // _x2 _x4 _x8: 1 2 3; _d2 _d4 _d8: -1 -2 -3
  bool saturate = false;    // _sat
  bool operator==(const Destination&) const = default;
};

// Of pixel programs, applied before `negate`: bias a-0.5, bx2 2a-1, x2 2a, invert 1-a; dz, dw divide the
// coordinates of a texld by their third or fourth component.
enum class SourceModifier : std::uint8_t { none, bias, bx2, invert, x2, dz, dw };

struct Source {
  RegisterFile file = RegisterFile::temporary;
  std::uint16_t index = 0;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};
  bool negate = false;
  bool relative = false;  // c[a0.x + index]
  SourceModifier modifier = SourceModifier::none;
  bool operator==(const Source&) const = default;
};

struct Instruction {
  Opcode opcode = Opcode::nop;
  Destination destination;
  std::array<Source, 3> sources;
  std::size_t source_count = 0;
  int line = 0;          // of the text (of a token program: of its disassembly), from 1
  int column = 0;        // from 1
  bool coissue = false;  // '+': issued together with the instruction before it

  std::span<const Source> used_sources() const { return std::span(sources).first(source_count); }
};

// def c#, x, y, z, w
struct Definition {
  std::uint16_t index = 0;
  std::array<float, 4> values{};
  std::size_t before = 0;  // its place: the instruction that it precedes
  int line = 0;
  int column = 0;
};

// dcl_usage v#
struct Declaration {
  std::uint8_t usage = 0;  // D3DDECLUSAGE
  std::uint8_t usage_index = 0;
  Destination destination;
  std::size_t before = 0;
  int line = 0;
  int column = 0;
};

struct Program {
  std::string name;  // file name, for messages
  Version version;
  std::vector<Instruction> instructions;
  std::vector<Definition> definitions;
  std::vector<Declaration> declarations;
};

// Text to program, checked against every rule of its version (validate.h).
// Throws UserError "name:line:column: rule" where the text does not assemble or breaks a rule.
Program load(std::string_view text, std::string_view name);

// Text to program by its syntax alone: a fragment need not be a valid program. Throws UserError as load does.
Program assemble(std::string_view text, std::string_view name);

// Instruction slots as Direct3D 8.1 counts them: 1 an instruction, macros at their expansion, def and dcl 0,
// a co-issued pair those of its longer half.
int slot_count(const Program& program);
// What instruction number `at` adds to them.
int slots_at(const Program& program, std::size_t at);

}  // namespace splatscope::isa
