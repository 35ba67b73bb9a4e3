#include <algorithm>
#include <span>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/pixel/registers.h"

// Texture address instructions, by their pages in the Direct3D reference.
namespace splatscope::pixel {
namespace {

using enum isa::Opcode;

void sample(int stage, const Register& coordinates, Registers& registers, const Context& context) {
  context.sampler(stage, coordinates.component, registers.textures[static_cast<std::size_t>(stage)],
                  context.count);
}

void kill_negative(const Lanes* components, const Context& context) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(context.count); ++i)
    if (components[0][i] < 0 || components[1][i] < 0 || components[2][i] < 0) context.batch.killed.set(i);
}

// numerator/denominator, or 1 where the denominator is 0.
void write_depth(const Lanes& numerator, const Lanes& denominator, const Context& context) {
  for (int i = 0; i < context.count; ++i)
    context.batch.depth[i] = denominator[i] == 0 ? 1.0f : numerator[i] / denominator[i];
}

// Texture coordinates of the stage, moved by the bump matrix of the stage times the red and green of the
// source.
Register bumped_coordinates(std::size_t stage, const Operand& source, const Context& context) {
  const auto& m = context.bump[stage].matrix;
  Register result{};
  for (int i = 0; i < context.count; ++i) {
    const float du = source.component[0][i], dv = source.component[1][i];
    result.component[0][i] = context.batch.t[stage][0][i] + m[0][0] * du + m[1][0] * dv;
    result.component[1][i] = context.batch.t[stage][1][i] + m[0][1] * du + m[1][1] * dv;
  }
  return result;
}

void scale_by_luminance(std::size_t stage, const Operand& source, Registers& registers,
                        const Context& context) {
  const BumpStage& bump = context.bump[stage];
  for (Lanes& component : std::span(registers.textures[stage], 4))
    for (int i = 0; i < context.count; ++i)
      component[i] *= source.component[2][i] * bump.luminance_scale + bump.luminance_offset;
}

// The product of the stage's coordinates u v w with the source's r g b, as the next row of a matrix.
void next_row(std::size_t stage, const Operand& source, Registers& registers, const Context& context) {
  const auto& t = context.batch.t[stage];
  const auto& s = source.component;
  float* row = registers.rows[registers.row++];
  for (int i = 0; i < context.count; ++i) row[i] = t[0][i] * s[0][i] + t[1][i] * s[1][i] + t[2][i] * s[2][i];
}

Register take_rows(Registers& registers, int count) {
  Register result{};
  for (int row = 0; row < registers.row; ++row)
    std::copy_n(registers.rows[row], count, result.component[row]);
  registers.row = 0;
  return result;
}

// 2 (N.E)/(N.N) N - E of the normal N in the rows, in place.
void reflect(Register& normal, const std::array<const float*, 3>& eye, int count) {
  auto& n = normal.component;
  for (int i = 0; i < count; ++i) {
    const float ne = n[0][i] * eye[0][i] + n[1][i] * eye[1][i] + n[2][i] * eye[2][i];
    const float nn = n[0][i] * n[0][i] + n[1][i] * n[1][i] + n[2][i] * n[2][i];
    const float scale = 2.0f * ne / nn;
    for (std::size_t k = 0; k < 3; ++k) n[k][i] = scale * n[k][i] - eye[k][i];
  }
}

// texreg2*: two or three components of the source as coordinates.
void sample_at_components(const isa::Instruction& instruction, const Operand& source,
                          std::array<int, 3> components, Registers& registers, const Context& context) {
  Register coordinates{};
  for (std::size_t k = 0; k < 3; ++k)
    if (components[k] >= 0)
      std::copy_n(source.component[static_cast<std::size_t>(components[k])], context.count,
                  coordinates.component[k]);
  sample(instruction.destination.index, coordinates, registers, context);
}

void last_row(const isa::Instruction& instruction, Registers& registers, const Context& context) {
  const std::size_t stage = instruction.destination.index;
  const auto& t = context.batch.t;
  Register rows = take_rows(registers, context.count);
  switch (instruction.opcode) {
    case texm3x2tex:
    case texm3x3tex:
      break;
    case texm3x2depth:
      return write_depth(rows.component[0], rows.component[1], context);
    case texm3x3:
      std::fill_n(rows.component[3], context.count, 1.0f);
      for (std::size_t k = 0; k < 4; ++k)
        std::copy_n(rows.component[k], context.count, registers.textures[stage][k]);
      return;
    case texm3x3spec: {
      const auto& eye = registers.constants[instruction.sources[1].index].component;
      reflect(rows, {eye[0], eye[1], eye[2]}, context.count);
      break;
    }
    default:
      reflect(rows, {t[stage - 2][3], t[stage - 1][3], t[stage][3]}, context.count);
      break;  // texm3x3vspec
  }
  sample(static_cast<int>(stage), rows, registers, context);
}

void run_to_1_3(const isa::Instruction& instruction, Registers& registers, const Context& context) {
  const std::size_t stage = instruction.destination.index;
  const int count = context.count;
  Lanes* const result = registers.textures[stage];
  const auto& coordinates = context.batch.t[stage];
  Register copy;
  const Operand source =
      instruction.source_count > 0 ? read(instruction.sources[0], registers, copy, count) : Operand{};
  switch (instruction.opcode) {
    case tex:
      return context.sampler(static_cast<int>(stage), coordinates, result, count);
    case texcoord:
      for (std::size_t k = 0; k < 3; ++k) clamp_lanes(coordinates[k], 0, 1, result[k], count);
      std::fill_n(result[3], count, 1.0f);
      return;
    case texkill:
      return kill_negative(coordinates, context);
    case texbem:
    case texbeml:
      sample(static_cast<int>(stage), bumped_coordinates(stage, source, context), registers, context);
      if (instruction.opcode == texbeml) scale_by_luminance(stage, source, registers, context);
      return;
    case texreg2ar:
      return sample_at_components(instruction, source, {3, 0, -1}, registers, context);
    case texreg2gb:
      return sample_at_components(instruction, source, {1, 2, -1}, registers, context);
    case texreg2rgb:
      return sample_at_components(instruction, source, {0, 1, 2}, registers, context);
    case texdp3:
    case texdp3tex: {
      next_row(stage, source, registers, context);
      Register product = take_rows(registers, count);  // (u, 0, 0)
      if (instruction.opcode == texdp3tex)
        return sample(static_cast<int>(stage), product, registers, context);
      for (Lanes& component : std::span(result, 4)) std::copy_n(product.component[0], count, component);
      return;
    }
    case texm3x2pad:
    case texm3x3pad:
      return next_row(stage, source, registers, context);
    default:
      next_row(stage, source, registers, context);
      return last_row(instruction, registers, context);
  }
}

// The coordinates of texld and texcrd: selected, and divided by the third or fourth component; 1 where that
// is 0 (Direct3D reference, "ps_1_4 Modifiers").
Register coordinates_1_4(const isa::Source& source, Registers& registers, int count) {
  const Lanes* const from = register_of(registers, source.file, source.index);
  Register result{};
  for (std::size_t k = 0; k < 3; ++k) std::copy_n(from[source.swizzle[k]], count, result.component[k]);
  const bool by_third = source.modifier == isa::SourceModifier::dz,
             by_fourth = source.modifier == isa::SourceModifier::dw;
  if (!by_third && !by_fourth) return result;
  const Lanes& divisor = from[by_third ? 2 : 3];
  for (std::size_t k = 0; k < 2; ++k)
    for (int i = 0; i < count; ++i) {
      float& coordinate = result.component[k][i];
      coordinate = divisor[i] == 0 ? 1 : coordinate / divisor[i];
    }
  std::fill_n(result.component[2], count, 0.0f);
  return result;
}

void run_1_4(const isa::Instruction& instruction, Registers& registers, const Context& context) {
  const isa::Destination& destination = instruction.destination;
  Lanes* const result = register_of(registers, destination.file, destination.index);
  switch (instruction.opcode) {
    case texkill:
      return kill_negative(result, context);
    case texdepth:
      return write_depth(result[0], result[1], context);
    case texld: {
      const Register coordinates = coordinates_1_4(instruction.sources[0], registers, context.count);
      context.sampler(destination.index, coordinates.component, result, context.count);
      for (Lanes& component : std::span(result, 4)) clamp_lanes(component, -8, 8, component, context.count);
      return;
    }
    case texcrd: {
      const Register coordinates = coordinates_1_4(instruction.sources[0], registers, context.count);
      for (std::size_t k = 0; k < 3; ++k)
        if (destination.mask & (1u << k))
          clamp_lanes(coordinates.component[k], -8, 8, result[k], context.count);
      return;
    }
    default:
      throw ModelError("not a texture address instruction of ps_1_4");
  }
}

}  // namespace

void run_texture_instruction(const isa::Instruction& instruction, Registers& registers,
                             const Context& context) {
  context.version.minor == 4 ? run_1_4(instruction, registers, context)
                             : run_to_1_3(instruction, registers, context);
}

}  // namespace splatscope::pixel
