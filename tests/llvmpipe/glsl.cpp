#include "tests/llvmpipe/glsl.h"

#include <fmt/format.h>

#include "model/error.h"

namespace splatscope::llvmpipe {
namespace {

constexpr std::string_view kLetters = "xyzw";

std::string name_of(isa::RegisterFile file, int index) {
  switch (file) {
    case isa::RegisterFile::temporary:
      return fmt::format("r{}", index);
    case isa::RegisterFile::input:
      return fmt::format("v{}", index);
    case isa::RegisterFile::constant:
      return fmt::format("c[{}]", index);
    case isa::RegisterFile::position_out:
      return "position";
    case isa::RegisterFile::color_out:
      return "color";
    case isa::RegisterFile::texcoord_out:
      return "coordinates";
    default:
      throw ModelError("not a register that splatting uses");
  }
}

std::string source(const isa::Source& source) {
  std::string swizzle;
  for (const std::uint8_t component : source.swizzle) swizzle += kLetters[component];
  return fmt::format("{}{}.{}", source.negate ? "-" : "", name_of(source.file, source.index), swizzle);
}

// A vec4.
std::string result(const isa::Instruction& instruction) {
  const auto s = [&](std::size_t i) { return source(instruction.sources[i]); };
  using enum isa::Opcode;
  switch (instruction.opcode) {
    case mov:
      return s(0);
    case add:
      return fmt::format("{} + {}", s(0), s(1));
    case mul:
      return fmt::format("{} * {}", s(0), s(1));
    case mad:
      return fmt::format("{} * {} + {}", s(0), s(1), s(2));
    case dp3:
      return fmt::format("vec4(dot(({}).xyz, ({}).xyz))", s(0), s(1));
    case dp4:
      return fmt::format("vec4(dot({}, {}))", s(0), s(1));
    case min:
      return fmt::format("min({}, {})", s(0), s(1));
    case max:
      return fmt::format("max({}, {})", s(0), s(1));
    case slt:
      return fmt::format("vec4(lessThan({}, {}))", s(0), s(1));
    case sge:
      return fmt::format("vec4(greaterThanEqual({}, {}))", s(0), s(1));
    case rcp:
      return fmt::format("vec4(1.0 / ({}).x)", s(0));
    case rsq:
      return fmt::format("vec4(inversesqrt(abs(({}).x)))", s(0));
    default:
      throw ModelError("not an instruction that splatting uses");
  }
}

}  // namespace

std::string vertex_shader(const isa::Program& program) {
  std::string text =
      "precision highp float;\nuniform vec4 c[96];\nuniform vec2 pixel;\nvarying vec4 color;\nvarying vec2 "
      "texcoord;\n";
  for (int input = 0; input < 6; ++input) text += fmt::format("attribute vec4 v{};\n", input);
  text += "void main() {\nvec4 position = vec4(0.0), coordinates = vec4(0.0);\n";
  text += "vec4 r0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11;\ncolor = vec4(1.0);\n";
  for (const isa::Instruction& instruction : program.instructions) {
    const isa::Destination& to = instruction.destination;
    std::string mask;
    for (std::size_t component = 0; component < 4; ++component)
      if (to.mask >> component & 1) mask += kLetters[component];
    text += fmt::format("{}.{} = ({}).{};\n", name_of(to.file, to.index), mask, result(instruction), mask);
  }
  // Direct3D 8's z is between 0 and w, its y the other way round, its pixel centres half a pixel off, and its
  // attributes saturate.
  return text +
         "color = clamp(color, 0.0, 1.0);\ntexcoord = coordinates.xy;\n"
         "gl_Position = vec4(position.xy * vec2(1.0, -1.0) + pixel * position.w,\n"
         "                   2.0 * position.z - position.w, position.w);\n}\n";
}

std::string splat_fragment_shader() {
  return "precision highp float;\nuniform sampler2D alpha;\nvarying vec4 color;\nvarying vec2 texcoord;\n"
         "void main() { gl_FragColor = vec4(color.rgb, color.a * texture2D(alpha, texcoord).a); }\n";
}

std::string empty_fragment_shader() {
  return "precision highp float;\nvoid main() { gl_FragColor = vec4(0.0); }\n";
}

}  // namespace splatscope::llvmpipe
