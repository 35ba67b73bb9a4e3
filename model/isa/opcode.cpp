#include "model/isa/opcode.h"

#include <fmt/format.h>

#include <algorithm>

namespace splatscope::isa {
namespace {

using enum Opcode;
constexpr ShaderKind kVertex = ShaderKind::vertex;
constexpr ShaderKind kPixel = ShaderKind::pixel;
constexpr OpcodeClass kArithmetic = OpcodeClass::arithmetic;
constexpr OpcodeClass kTexture = OpcodeClass::texture;
constexpr OpcodeClass kFlow = OpcodeClass::flow;

constexpr OpcodeInfo kTable[] = {
    {nop, "nop", 0x00, kVertex, 1, 1, false, 0, 1, kFlow},
    {mov, "mov", 0x01, kVertex, 1, 1, true, 1, 1, kArithmetic},
    {add, "add", 0x02, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {sub, "sub", 0x03, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {mad, "mad", 0x04, kVertex, 1, 1, true, 3, 1, kArithmetic},
    {mul, "mul", 0x05, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {rcp, "rcp", 0x06, kVertex, 1, 1, true, 1, 1, kArithmetic},
    {rsq, "rsq", 0x07, kVertex, 1, 1, true, 1, 1, kArithmetic},
    {dp3, "dp3", 0x08, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {dp4, "dp4", 0x09, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {min, "min", 0x0a, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {max, "max", 0x0b, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {slt, "slt", 0x0c, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {sge, "sge", 0x0d, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {exp, "exp", 0x0e, kVertex, 1, 1, true, 1, 10, kArithmetic},
    {log, "log", 0x0f, kVertex, 1, 1, true, 1, 10, kArithmetic},
    {lit, "lit", 0x10, kVertex, 1, 1, true, 1, 1, kArithmetic},
    {dst, "dst", 0x11, kVertex, 1, 1, true, 2, 1, kArithmetic},
    {frc, "frc", 0x13, kVertex, 1, 1, true, 1, 3, kArithmetic},
    {m4x4, "m4x4", 0x14, kVertex, 1, 1, true, 2, 4, kArithmetic},
    {m4x3, "m4x3", 0x15, kVertex, 1, 1, true, 2, 3, kArithmetic},
    {m3x4, "m3x4", 0x16, kVertex, 1, 1, true, 2, 4, kArithmetic},
    {m3x3, "m3x3", 0x17, kVertex, 1, 1, true, 2, 3, kArithmetic},
    {m3x2, "m3x2", 0x18, kVertex, 1, 1, true, 2, 2, kArithmetic},
    {expp, "expp", 0x4e, kVertex, 1, 1, true, 1, 1, kArithmetic},
    {logp, "logp", 0x4f, kVertex, 1, 1, true, 1, 1, kArithmetic},

    {nop, "nop", 0x00, kPixel, 1, 4, false, 0, 0, kFlow},
    {mov, "mov", 0x01, kPixel, 1, 4, true, 1, 1, kArithmetic},
    {add, "add", 0x02, kPixel, 1, 4, true, 2, 1, kArithmetic},
    {sub, "sub", 0x03, kPixel, 1, 4, true, 2, 1, kArithmetic},
    {mad, "mad", 0x04, kPixel, 1, 4, true, 3, 1, kArithmetic},
    {mul, "mul", 0x05, kPixel, 1, 4, true, 2, 1, kArithmetic},
    {dp3, "dp3", 0x08, kPixel, 1, 4, true, 2, 1, kArithmetic},
    {dp4, "dp4", 0x09, kPixel, 2, 3, true, 2, 2, kArithmetic},
    {dp4, "dp4", 0x09, kPixel, 4, 4, true, 2, 1, kArithmetic},
    {lrp, "lrp", 0x12, kPixel, 1, 4, true, 3, 1, kArithmetic},
    {cnd, "cnd", 0x50, kPixel, 1, 4, true, 3, 1, kArithmetic},
    {cmp, "cmp", 0x58, kPixel, 2, 3, true, 3, 2, kArithmetic},
    {cmp, "cmp", 0x58, kPixel, 4, 4, true, 3, 1, kArithmetic},
    {bem, "bem", 0x59, kPixel, 4, 4, true, 2, 2, kArithmetic},
    {phase, "phase", 0xfffd, kPixel, 4, 4, false, 0, 0, kFlow},
    {texcoord, "texcoord", 0x40, kPixel, 1, 3, true, 0, 1, kTexture},
    {texcrd, "texcrd", 0x40, kPixel, 4, 4, true, 1, 1, kTexture},
    {texkill, "texkill", 0x41, kPixel, 1, 4, true, 0, 1, kTexture},
    {tex, "tex", 0x42, kPixel, 1, 3, true, 0, 1, kTexture},
    {texld, "texld", 0x42, kPixel, 4, 4, true, 1, 1, kTexture},
    {texbem, "texbem", 0x43, kPixel, 1, 3, true, 1, 1, kTexture},
    {texbeml, "texbeml", 0x44, kPixel, 1, 3, true, 1, 2, kTexture},
    {texreg2ar, "texreg2ar", 0x45, kPixel, 1, 3, true, 1, 1, kTexture},
    {texreg2gb, "texreg2gb", 0x46, kPixel, 1, 3, true, 1, 1, kTexture},
    {texm3x2pad, "texm3x2pad", 0x47, kPixel, 1, 3, true, 1, 1, kTexture},
    {texm3x2tex, "texm3x2tex", 0x48, kPixel, 1, 3, true, 1, 1, kTexture},
    {texm3x3pad, "texm3x3pad", 0x49, kPixel, 1, 3, true, 1, 1, kTexture},
    {texm3x3tex, "texm3x3tex", 0x4a, kPixel, 1, 3, true, 1, 1, kTexture},
    {texm3x3spec, "texm3x3spec", 0x4c, kPixel, 1, 3, true, 2, 1, kTexture},
    {texm3x3vspec, "texm3x3vspec", 0x4d, kPixel, 1, 3, true, 1, 1, kTexture},
    {texreg2rgb, "texreg2rgb", 0x52, kPixel, 2, 3, true, 1, 1, kTexture},
    {texdp3tex, "texdp3tex", 0x53, kPixel, 2, 3, true, 1, 1, kTexture},
    {texm3x2depth, "texm3x2depth", 0x54, kPixel, 3, 3, true, 1, 1, kTexture},
    {texdp3, "texdp3", 0x55, kPixel, 2, 3, true, 1, 1, kTexture},
    {texm3x3, "texm3x3", 0x56, kPixel, 2, 3, true, 1, 1, kTexture},
    {texdepth, "texdepth", 0x57, kPixel, 4, 4, true, 0, 1, kTexture},
};

template <typename Predicate>
const OpcodeInfo* find_row(Version version, Predicate predicate) {
  const auto row = std::ranges::find_if(kTable, [&](const OpcodeInfo& info) {
    return info.kind == version.kind && version.major == 1 && info.first_minor <= version.minor &&
           version.minor <= info.last_minor && predicate(info);
  });
  return row == std::end(kTable) ? nullptr : row;
}

}  // namespace

std::span<const OpcodeInfo> opcode_table() {
  return kTable;
}

const OpcodeInfo* find_opcode(Version version, std::string_view name) {
  return find_row(version, [&](const OpcodeInfo& info) { return info.name == name; });
}

const OpcodeInfo* find_opcode(Version version, std::uint16_t token) {
  return find_row(version, [&](const OpcodeInfo& info) { return info.token == token; });
}

const OpcodeInfo* find_opcode(Version version, Opcode opcode) {
  return find_row(version, [&](const OpcodeInfo& info) { return info.opcode == opcode; });
}

std::string to_string(Version version) {
  return fmt::format("{}_{}_{}", version.kind == ShaderKind::vertex ? "vs" : "ps", version.major,
                     version.minor);
}

MatrixShape matrix_shape(Opcode opcode) {
  switch (opcode) {
    case m4x4:
      return {4, 4};
    case m4x3:
      return {3, 4};
    case m3x4:
      return {4, 3};
    case m3x3:
      return {3, 3};
    case m3x2:
      return {2, 3};
    default:
      return {0, 0};
  }
}

int texture_matrix_rows(Opcode opcode) {
  switch (opcode) {
    case texm3x2pad:
    case texm3x2tex:
    case texm3x2depth:
      return 2;
    case texm3x3pad:
    case texm3x3tex:
    case texm3x3spec:
    case texm3x3vspec:
    case texm3x3:
      return 3;
    default:
      return 0;
  }
}

int slots_at(const Program& program, std::size_t at) {
  const auto slots = [&](const Instruction& instruction) {
    const OpcodeInfo* info = find_opcode(program.version, instruction.opcode);
    return info ? info->slots : 0;
  };
  const int own = slots(program.instructions[at]);
  if (!program.instructions[at].coissue || at == 0) return own;
  return std::max(0, own - slots(program.instructions[at - 1]));
}

int slot_count(const Program& program) {
  int slots = 0;
  for (std::size_t at = 0; at < program.instructions.size(); ++at) slots += slots_at(program, at);
  return slots;
}

}  // namespace splatscope::isa
