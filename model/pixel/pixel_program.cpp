#include "model/pixel/pixel_program.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/isa/pixel_limits.h"
#include "model/pixel/registers.h"

namespace splatscope::pixel {
namespace {

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

ResultFormat result_format(isa::Version version, CombinerFormat format) {
  const float range = version.minor == 4 ? 8.0f : 1.0f;
  if (format == CombinerFormat::unbounded)
    return {-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(), false};
  return {-range, range, format == CombinerFormat::signed9};
}

float scale_of(const isa::Destination& destination) {
  return destination.shift >= 0 ? static_cast<float>(1 << destination.shift)
                                : 1.0f / static_cast<float>(1 << -destination.shift);
}

bool reads(const isa::Instruction& instruction, const isa::Destination& destination) {
  return std::ranges::any_of(instruction.used_sources(), [&](const isa::Source& source) {
    return source.file == destination.file && source.index == destination.index;
  });
}

bool is_texture(isa::Version version, isa::Opcode opcode) {
  return isa::find_opcode(version, opcode)->unit == isa::OpcodeClass::texture;
}

}  // namespace

Lanes* register_of(Registers& registers, isa::RegisterFile file, std::size_t index) {
  switch (file) {
    case isa::RegisterFile::temporary:
      return registers.temporaries[index];
    case isa::RegisterFile::constant:
      return registers.constants[index].component;
    case isa::RegisterFile::input:
      return registers.inputs[index];
    case isa::RegisterFile::texture:
      return registers.textures[index];
    default:
      throw ModelError("not a register of pixel programs");
  }
}

Operand read(const isa::Source& source, Registers& registers, Register& copy, int count) {
  const Lanes* const from = register_of(registers, source.file, source.index);
  const bool plain = source.modifier == isa::SourceModifier::none && !source.negate;
  const Affine affine = affine_of(source);
  Operand operand;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const Lanes& values = from[source.swizzle[lane]];
    operand.component[lane] = plain ? values : copy.component[lane];
    if (!plain) scale_lanes(values, affine.scale, affine.offset, copy.component[lane], count);
  }
  return operand;
}

struct PixelProgram::Decoded {
  isa::Version version;
  ResultFormat format{};
  struct Step {
    isa::Instruction instruction;
    bool texture;
    std::size_t place;      // in the program
    bool in_place = false;  // neither it nor what is issued with it reads a register that they write
  };
  std::vector<Step> steps;
  std::array<std::optional<Vec4>, isa::kPixelConstants> defined;
  unsigned constants = 0, inputs = 0, textures = 0;  // used: bit n
  unsigned textures_written = 0;                     // otherwise than by being sampled
  unsigned stages = 0;                               // sampled: bit n
  bool writes_depth = false;
  bool samples_ahead = true;

  std::size_t instructions = 0;

  void append(const isa::Instruction& instruction, std::size_t place);
  void decide_in_place(std::size_t issued);  // of the last steps, which are issued together
  std::size_t execute(std::size_t at, Registers& registers, const Context& context) const;
  void run(std::span<const Vec4> values, FragmentBatch& batch, int count, const Sampler& sampler,
           const BumpStages& bump, bool sampled_ahead) const;
  void use(isa::RegisterFile file, std::size_t index);
  void prepare(std::span<const Vec4> values, FragmentBatch& batch, int count, bool sampled_ahead,
               Registers& registers) const;
};

void PixelProgram::Decoded::use(isa::RegisterFile file, std::size_t index) {
  const unsigned bit = 1u << index;
  switch (file) {
    case isa::RegisterFile::constant:
      constants |= bit;
      break;
    case isa::RegisterFile::input:
      inputs |= bit;
      break;
    case isa::RegisterFile::texture:
      textures |= bit;
      break;
    default:
      break;
  }
}

void PixelProgram::Decoded::append(const isa::Instruction& instruction, std::size_t place) {
  using enum isa::Opcode;
  const bool texture = is_texture(version, instruction.opcode);
  steps.push_back({instruction, texture, place});
  if (!texture) decide_in_place(instruction.coissue ? 2 : 1);
  use(instruction.destination.file, instruction.destination.index);
  if (instruction.destination.file == isa::RegisterFile::texture && instruction.opcode != tex)
    textures_written |= 1u << instruction.destination.index;
  for (const isa::Source& source : instruction.used_sources()) use(source.file, source.index);
  if (!texture) return;
  writes_depth |= instruction.opcode == texdepth || instruction.opcode == texm3x2depth;
  const bool none =
      instruction.opcode == texkill || instruction.opcode == texdepth || instruction.opcode == texcoord ||
      instruction.opcode == texcrd || instruction.opcode == texm3x2pad || instruction.opcode == texm3x3pad ||
      instruction.opcode == texm3x3 || instruction.opcode == texdp3 || instruction.opcode == texm3x2depth;
  if (!none) stages |= 1u << instruction.destination.index;
  isa::Source source = instruction.sources[0];
  source.swizzle[3] = 3;  // t#.xyz is t#
  const bool own = source == isa::Source{isa::RegisterFile::texture, instruction.destination.index};
  samples_ahead &=
      instruction.opcode == tex || instruction.opcode == texcoord || (instruction.opcode == texld && own);
}

void PixelProgram::Decoded::decide_in_place(std::size_t issued) {
  const auto last = std::span(steps).last(issued);
  const bool conflict = std::ranges::any_of(last, [&](const Step& reader) {
    return std::ranges::any_of(
        last, [&](const Step& writer) { return reads(reader.instruction, writer.instruction.destination); });
  });
  for (Step& step : last) step.in_place = !conflict;
}

void PixelProgram::Decoded::prepare(std::span<const Vec4> values, FragmentBatch& batch, int count,
                                    bool sampled_ahead, Registers& registers) const {
  registers.inputs = {batch.v0, batch.v1};
  for (std::size_t i = 0; i < registers.inputs.size(); ++i) {
    if (sampled_ahead || (inputs & 1u << i) == 0) continue;  // sampled ahead, colours are in their range
    Lanes* const own = registers.own_inputs[i].component;
    for (std::size_t c = 0; c < 4; ++c) clamp_lanes(registers.inputs[i][c], 0.0f, 1.0f, own[c], count);
    registers.inputs[i] = own;
  }
  for (std::size_t i = 0; i < defined.size(); ++i) {
    if ((constants & 1u << i) == 0) continue;
    const Vec4 value = defined[i] ? *defined[i] : i < values.size() ? values[i] : Vec4{};
    for (std::size_t c = 0; c < 4; ++c)
      std::fill_n(registers.constants[i].component[c], count, in_range(value[c], -1.0f, 1.0f));
  }
  for (std::size_t i = 0; i < kStages; ++i) {
    registers.temporaries[i] = i == 0 ? batch.r0 : registers.own_temporaries[i].component;
    const bool own = !sampled_ahead || (textures_written & 1u << i) != 0;
    registers.textures[i] = own ? registers.own_textures[i].component : batch.t[i];
    if (!own || (textures & 1u << i) == 0) continue;
    for (std::size_t c = 0; c < 4; ++c) std::copy_n(batch.t[i][c], count, registers.textures[i][c]);
  }
}

PixelProgram::PixelProgram(const isa::Program& program, CombinerFormat format)
    : decoded_(std::make_unique<Decoded>()) {
  decoded_->version = program.version;
  decoded_->format = result_format(program.version, format);
  for (const isa::Definition& definition : program.definitions)
    decoded_->defined.at(definition.index) = definition.values;
  decoded_->instructions = program.instructions.size();
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    const isa::Opcode opcode = program.instructions[i].opcode;
    if (opcode != isa::Opcode::nop && opcode != isa::Opcode::phase)
      decoded_->append(program.instructions[i], i);
  }
}

PixelProgram::~PixelProgram() = default;
PixelProgram::PixelProgram(PixelProgram&&) noexcept = default;

unsigned PixelProgram::texture_stages() const {
  return decoded_->stages;
}
bool PixelProgram::writes_depth() const {
  return decoded_->writes_depth;
}
bool PixelProgram::samples_ahead() const {
  return decoded_->samples_ahead;
}

void PixelProgram::run(std::span<const Vec4> constants, FragmentBatch& batch, int count) const {
  if (!samples_ahead()) throw ModelError("this pixel program samples as it runs: it needs a sampler");
  const Sampler sampled_ahead = [&](int stage, const Lanes*, Lanes* texel, int lanes) {
    for (std::size_t component = 0; component < 4; ++component)
      std::copy_n(batch.t[stage][component], lanes, texel[component]);
  };
  decoded_->run(constants, batch, count, sampled_ahead, {}, true);
}

// One instruction or co-issued pair; returns the step after it.
std::size_t PixelProgram::Decoded::execute(std::size_t at, Registers& registers,
                                           const Context& context) const {
  if (steps[at].texture) {
    const bool sampled = context.sampled_ahead && steps[at].instruction.opcode == isa::Opcode::tex;
    if (!sampled) run_texture_instruction(steps[at].instruction, registers, context);
    return at + 1;
  }
  // Both halves of a pair read before either writes.
  Register copies[3], results[2];
  const std::size_t issued = at + 1 < steps.size() && steps[at + 1].instruction.coissue ? 2 : 1;
  for (std::size_t k = 0; k < issued; ++k) {
    const isa::Instruction& instruction = steps[at + k].instruction;
    std::array<Operand, 3> sources{};
    for (std::size_t i = 0; i < instruction.source_count; ++i)
      sources[i] = read(instruction.sources[i], registers, copies[i], context.count);
    const isa::Destination& destination = instruction.destination;
    const bool select_by_alpha = version.minor < 4;  // cnd
    const float low = destination.saturate ? 0.0f : format.low,
                high = destination.saturate ? 1.0f : format.high;
    const Operation operation{instruction.opcode,
                              destination.mask,
                              select_by_alpha,
                              sources,
                              context.bump[destination.index].matrix,
                              scale_of(destination),
                              {low, high, format.steps}};
    Lanes* const to = register_of(registers, destination.file, destination.index);
    compute_lanes(operation, context.count, steps[at + k].in_place ? to : results[k].component);
  }
  for (std::size_t k = 0; k < issued; ++k) {
    if (steps[at + k].in_place) continue;
    const isa::Destination& destination = steps[at + k].instruction.destination;
    Lanes* const to = register_of(registers, destination.file, destination.index);
    for (std::size_t component = 0; component < 4; ++component)
      if (destination.mask & (1u << component))
        std::copy_n(results[k].component[component], context.count, to[component]);
  }
  return at + issued;
}

void PixelProgram::run(std::span<const Vec4> constants, FragmentBatch& batch, int count,
                       const Sampler& sampler, const BumpStages& bump) const {
  decoded_->run(constants, batch, count, sampler, bump, false);
}

void PixelProgram::Decoded::run(std::span<const Vec4> values, FragmentBatch& batch, int count,
                                const Sampler& sampler, const BumpStages& bump, bool sampled_ahead) const {
  Registers registers;
  prepare(values, batch, count, sampled_ahead, registers);
  batch.killed.reset();
  const Context context{version, batch, count, sampler, bump, sampled_ahead};
  for (std::size_t at = 0; at < steps.size();) at = execute(at, registers, context);
}

std::vector<FragmentState> PixelProgram::trace(std::span<const Vec4> constants, FragmentBatch& batch,
                                               const Sampler& sampler, const BumpStages& bump) const {
  const auto registers = std::make_unique<Registers>();
  decoded_->prepare(constants, batch, 1, false, *registers);
  for (Lanes& component : batch.r0) component[0] = 0;  // the others are
  batch.depth[0] = 0;
  batch.killed.reset();
  const Context context{decoded_->version, batch, 1, sampler, bump};
  const auto state = [&] {
    FragmentState result;
    for (std::size_t i = 0; i < kStages; ++i)
      for (std::size_t c = 0; c < 4; ++c) {
        result.temporaries[i][c] = registers->temporaries[i][c][0];
        result.textures[i][c] = registers->textures[i][c][0];
      }
    result.depth = batch.depth[0];
    return result;
  };
  std::vector<FragmentState> states{state()};
  std::size_t at = 0;
  for (std::size_t place = 0; place < decoded_->instructions; ++place) {
    if (at < decoded_->steps.size() && decoded_->steps[at].place == place)
      at = decoded_->execute(at, *registers, context);
    states.push_back(state());
  }
  return states;
}

}  // namespace splatscope::pixel
