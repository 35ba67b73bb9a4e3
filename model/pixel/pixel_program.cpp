#include "model/pixel/pixel_program.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "model/error.h"

namespace splatscope::pixel {
namespace {

constexpr std::size_t kConstants = 8;
constexpr std::size_t kTemporaries = 6;

using Lanes = float[kBatch];
struct alignas(64) Register {
  Lanes component[4];
};

// Ranges of the registers (Direct3D 8.1 reference, "Registers - ps_1_X").
struct Ranges {
  float temporary;        // r# and, up to ps_1_3, t# as a destination: -temporary..temporary
  float constant = 1.0f;  // c#: -1..1
};

Ranges ranges_of(isa::Version version) {
  return {version.minor == 4 ? 8.0f : 1.0f};
}

// The registers of one batch while it runs.
struct Registers {
  Register temporaries[kTemporaries];
  Register constants[kConstants];
  Register inputs[2];
  Register textures[4];
};

// Four components to read: of a register itself, or of a copy that a modifier made.
struct Operand {
  std::array<const float*, 4> component;
};

Register& register_of(Registers& registers, isa::RegisterFile file, std::size_t index) {
  switch (file) {
    case isa::RegisterFile::temporary:
      return registers.temporaries[index];
    case isa::RegisterFile::constant:
      return registers.constants[index];
    case isa::RegisterFile::input:
      return registers.inputs[index];
    case isa::RegisterFile::texture:
      return registers.textures[index];
    default:
      throw ModelError("not a register of pixel programs");
  }
}

// value*scale + offset: what each source modifier and negation come to.
struct Affine {
  float scale;
  float offset;
};

Affine affine_of(const isa::Source& source) {
  Affine result{1.0f, 0.0f};
  switch (source.modifier) {
    case isa::SourceModifier::bias:
      result = {1.0f, -0.5f};
      break;
    case isa::SourceModifier::bx2:
      result = {2.0f, -1.0f};
      break;
    case isa::SourceModifier::x2:
      result = {2.0f, 0.0f};
      break;
    case isa::SourceModifier::invert:
      result = {-1.0f, 1.0f};
      break;
    default:
      break;
  }
  return source.negate ? Affine{-result.scale, -result.offset} : result;
}

Operand read(const isa::Source& source, Registers& registers, Register& copy, int count) {
  const Register& from = register_of(registers, source.file, source.index);
  const bool plain = source.modifier == isa::SourceModifier::none && !source.negate;
  const Affine affine = affine_of(source);
  Operand operand;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const Lanes& values = from.component[source.swizzle[lane]];
    operand.component[lane] = plain ? values : copy.component[lane];
    if (!plain)
      for (int i = 0; i < count; ++i) copy.component[lane][i] = values[i] * affine.scale + affine.offset;
  }
  return operand;
}

template <typename Function>
void each(const isa::Instruction& instruction, Register& result, int count, Function function) {
  for (std::size_t component = 0; component < 4; ++component) {
    if (!(instruction.destination.mask & (1u << component))) continue;
    float* out = result.component[component];
    for (int i = 0; i < count; ++i) out[i] = function(component, static_cast<std::size_t>(i));
  }
}

// The result before its modifiers, in the components of the mask.
void compute(const isa::Instruction& instruction, const std::array<Operand, 3>& sources, bool select_by_alpha,
             Register& result, int count) {
  const auto& a = sources[0].component;
  const auto& b = sources[1].component;
  const auto& c = sources[2].component;
  using std::size_t;
  switch (instruction.opcode) {
    case isa::Opcode::mov:
      return each(instruction, result, count, [&](size_t k, size_t i) { return a[k][i]; });
    case isa::Opcode::add:
      return each(instruction, result, count, [&](size_t k, size_t i) { return a[k][i] + b[k][i]; });
    case isa::Opcode::sub:
      return each(instruction, result, count, [&](size_t k, size_t i) { return a[k][i] - b[k][i]; });
    case isa::Opcode::mul:
      return each(instruction, result, count, [&](size_t k, size_t i) { return a[k][i] * b[k][i]; });
    case isa::Opcode::mad:
      return each(instruction, result, count,
                  [&](size_t k, size_t i) { return a[k][i] * b[k][i] + c[k][i]; });
    case isa::Opcode::lrp:
      return each(instruction, result, count,
                  [&](size_t k, size_t i) { return a[k][i] * (b[k][i] - c[k][i]) + c[k][i]; });
    case isa::Opcode::dp3:
      return each(instruction, result, count, [&](size_t, size_t i) {
        return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i];
      });
    case isa::Opcode::dp4:
      return each(instruction, result, count, [&](size_t, size_t i) {
        return a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i] + a[3][i] * b[3][i];
      });
    case isa::Opcode::cnd:
      return each(instruction, result, count, [&](size_t k, size_t i) {
        return (select_by_alpha ? a[3][i] : a[k][i]) > 0.5f ? b[k][i] : c[k][i];
      });
    case isa::Opcode::cmp:
      return each(instruction, result, count,
                  [&](size_t k, size_t i) { return a[k][i] >= 0.0f ? b[k][i] : c[k][i]; });
    default:
      throw ModelError("not an arithmetic instruction of pixel programs");
  }
}

// Destination modifiers, then the range of the register.
void commit(const isa::Instruction& instruction, float range, const Register& result, Registers& registers,
            int count) {
  const isa::Destination& destination = instruction.destination;
  Register& to = register_of(registers, destination.file, destination.index);
  const float scale = destination.shift >= 0 ? static_cast<float>(1 << destination.shift)
                                             : 1.0f / static_cast<float>(1 << -destination.shift);
  const float low = destination.saturate ? 0.0f : -range;
  const float high = destination.saturate ? 1.0f : range;
  for (std::size_t component = 0; component < 4; ++component) {
    if (!(destination.mask & (1u << component))) continue;
    for (int i = 0; i < count; ++i)
      to.component[component][i] = std::min(std::max(result.component[component][i] * scale, low), high);
  }
}

void clamp_lanes(const float* from, float low, float high, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] = std::min(std::max(from[i], low), high);
}

}  // namespace

struct PixelProgram::Decoded {
  isa::Version version;
  std::vector<isa::Instruction> arithmetic;
  std::vector<isa::Definition> definitions;
  unsigned stages = 0;
};

PixelProgram::PixelProgram(const isa::Program& program) : decoded_(std::make_unique<Decoded>()) {
  decoded_->version = program.version;
  decoded_->definitions = program.definitions;
  for (const isa::Instruction& instruction : program.instructions) {
    if (instruction.opcode == isa::Opcode::nop) continue;
    if (instruction.opcode == isa::Opcode::tex)
      decoded_->stages |= 1u << instruction.destination.index;
    else
      decoded_->arithmetic.push_back(instruction);
  }
}

PixelProgram::~PixelProgram() = default;
PixelProgram::PixelProgram(PixelProgram&&) noexcept = default;
PixelProgram& PixelProgram::operator=(PixelProgram&&) noexcept = default;

unsigned PixelProgram::texture_stages() const {
  return decoded_->stages;
}

void PixelProgram::run(std::span<const Vec4> constants, FragmentBatch& batch, int count) const {
  const Ranges ranges = ranges_of(decoded_->version);
  Registers registers;
  std::array<Vec4, kConstants> values{};
  std::copy_n(constants.begin(), std::min(constants.size(), kConstants), values.begin());
  for (const isa::Definition& definition : decoded_->definitions)
    values[definition.index] = definition.values;
  for (std::size_t component = 0; component < 4; ++component) {
    for (std::size_t i = 0; i < kConstants; ++i)
      std::fill_n(registers.constants[i].component[component], count,
                  std::clamp(values[i][component], -ranges.constant, ranges.constant));
    clamp_lanes(batch.v0[component], 0.0f, 1.0f, registers.inputs[0].component[component], count);
    clamp_lanes(batch.v1[component], 0.0f, 1.0f, registers.inputs[1].component[component], count);
    for (std::size_t stage = 0; stage < 4; ++stage)
      std::copy_n(batch.t[stage][component], count, registers.textures[stage].component[component]);
    for (Register& temporary : registers.temporaries)
      std::fill_n(temporary.component[component], count, 0.0f);
  }
  Register copies[3], results[2];
  const auto& program = decoded_->arithmetic;
  for (std::size_t at = 0; at < program.size();) {
    // Both halves of a co-issued pair read before either writes.
    const std::size_t issued = at + 1 < program.size() && program[at + 1].coissue ? 2 : 1;
    for (std::size_t k = 0; k < issued; ++k) {
      const isa::Instruction& instruction = program[at + k];
      std::array<Operand, 3> sources{};
      for (std::size_t i = 0; i < static_cast<std::size_t>(instruction.source_count); ++i)
        sources[i] = read(instruction.sources[i], registers, copies[i], count);
      compute(instruction, sources, decoded_->version.minor < 4, results[k], count);
    }
    for (std::size_t k = 0; k < issued; ++k)
      commit(program[at + k], ranges.temporary, results[k], registers, count);
    at += issued;
  }
  for (std::size_t component = 0; component < 4; ++component)
    std::copy_n(registers.temporaries[0].component[component], count, batch.r0[component]);
}

}  // namespace splatscope::pixel
