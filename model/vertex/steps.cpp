#include "model/vertex/steps.h"

#include <bit>
#include <cmath>

#include "model/error.h"
#include "model/isa/opcode.h"
#include "model/vertex/processor_mode.h"

namespace splatscope::vertex {
namespace {

constexpr std::int32_t kOutOfRange = -0x10000;

Operation operation_of(isa::Opcode opcode) {
  using enum isa::Opcode;
  switch (opcode) {
    case mov:
      return Operation::move;
    case add:
    case sub:
      return Operation::add;
    case mul:
      return Operation::multiply;
    case mad:
      return Operation::multiply_add;
    case dp3:
    case m3x4:
    case m3x3:
    case m3x2:
      return Operation::dot3;
    case dp4:
    case m4x4:
    case m4x3:
      return Operation::dot4;
    case min:
      return Operation::minimum;
    case max:
      return Operation::maximum;
    case slt:
      return Operation::less;
    case sge:
      return Operation::greater_equal;
    case rcp:
      return Operation::reciprocal;
    case rsq:
      return Operation::reciprocal_sqrt;
    case expp:
      return Operation::expp;
    case logp:
      return Operation::logp;
    case lit:
      return Operation::lit;
    case dst:
      return Operation::distance;
    case exp:
      return Operation::exponent;
    case log:
      return Operation::logarithm;
    case frc:
      return Operation::fraction;
    default:
      throw ModelError("not an instruction of vertex programs");
  }
}

void set_destination(const isa::Destination& destination, Step& step) {
  step.mask = destination.mask;
  if (destination.file == isa::RegisterFile::temporary) {
    step.destination_place = Place::temporary;
    step.destination_index = destination.index;
  } else if (destination.file == isa::RegisterFile::address) {
    step.operation = Operation::load_address;
    step.destination_place = Place::address;
  } else if (const auto output = output_of(destination.file, destination.index)) {
    step.destination_place = Place::output;
    step.destination_index = static_cast<std::uint16_t>(*output);
  } else {
    throw ModelError("not a destination of vertex programs");
  }
}

// A source's place; a relative constant becomes a gather before the step that reads it.
StepSource make_source(const isa::Source& source, int row, std::vector<Step>& steps) {
  StepSource result;
  result.swizzle = source.swizzle;
  result.negate = source.negate;
  result.index = static_cast<std::uint16_t>(source.index + row);
  switch (source.file) {
    case isa::RegisterFile::temporary:
      result.place = Place::temporary;
      return result;
    case isa::RegisterFile::input:
      result.place = Place::input;
      return result;
    case isa::RegisterFile::constant:
      break;
    default:
      throw ModelError("not a source of vertex programs");
  }
  if (!source.relative) {
    result.place = Place::constant;
    return result;
  }
  Step gather;
  gather.operation = Operation::gather_constant;
  gather.destination_place = Place::scratch;
  gather.constant_offset = result.index;
  steps.push_back(gather);
  result.place = Place::scratch;
  result.index = 0;
  return result;
}

void append(const isa::Instruction& instruction, std::vector<Step>& steps) {
  const int rows = isa::matrix_shape(instruction.opcode).rows;
  for (int row = 0; row < std::max(rows, 1); ++row) {
    Step step;
    step.operation = operation_of(instruction.opcode);
    set_destination(instruction.destination, step);
    if (rows > 0) step.mask = static_cast<std::uint8_t>(step.mask & (1u << row));
    if (step.mask == 0) continue;
    step.source_count = static_cast<std::uint8_t>(instruction.source_count);
    for (std::size_t i = 0; i < step.source_count; ++i)
      step.sources[i] = make_source(instruction.sources[i], i == 1 ? row : 0, steps);
    if (instruction.opcode == isa::Opcode::sub) step.sources[1].negate = !step.sources[1].negate;
    steps.push_back(step);
  }
}

float negated(float value, std::uint32_t sign) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) ^ sign);
}

Operand resolve_source(const StepSource& source, const Workspace& workspace, const InputBatch& in) {
  Operand operand;
  operand.sign = source.negate ? 0x80000000u : 0u;
  operand.stride = source.place == Place::constant ? 0 : 1;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const std::size_t component = source.swizzle[lane];
    switch (source.place) {
      case Place::temporary:
        operand.component[lane] = workspace.temporaries[source.index][component];
        operand.special = &workspace.special.temporaries[source.index];
        break;
      case Place::input:
        operand.component[lane] = in.v[source.index][component];
        operand.special = &workspace.special.inputs[source.index];
        break;
      case Place::constant:
        operand.component[lane] = workspace.broadcast[source.index][component];
        operand.special = &workspace.special.constants[source.index];
        break;
      default:
        operand.component[lane] = workspace.scratch[component];
        operand.special = &workspace.special.scratch;
        break;
    }
  }
  return operand;
}

}  // namespace

std::optional<int> output_of(isa::RegisterFile file, int index) {
  switch (file) {
    case isa::RegisterFile::position_out:
      return oPos;
    case isa::RegisterFile::color_out:
      return oD0 + index;
    case isa::RegisterFile::texcoord_out:
      return oT0 + index;
    case isa::RegisterFile::fog_out:
      return oFog;
    case isa::RegisterFile::point_size_out:
      return oPts;
    default:
      return std::nullopt;
  }
}

std::vector<Step> make_steps(const isa::Program& program) {
  std::vector<Step> steps;
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    const std::size_t first = steps.size();
    if (program.instructions[i].opcode != isa::Opcode::nop) append(program.instructions[i], steps);
    for (std::size_t k = first; k < steps.size(); ++k) steps[k].instruction = static_cast<std::uint32_t>(i);
  }
  return steps;
}

Call resolve(const Step& step, Workspace& workspace, const InputBatch& in, OutputBatch& out) {
  Call call;
  call.operation = step.operation;
  for (std::uint8_t component = 0; component < 4; ++component)
    if (step.mask & (1u << component)) call.components[call.component_count++] = component;
  const bool temporary = step.destination_place == Place::temporary;
  call.destination =
      temporary ? workspace.temporaries[step.destination_index][0] : out.o[step.destination_index][0];
  call.special =
      temporary ? &workspace.special.temporaries[step.destination_index] : &workspace.special.outputs;
  call.source_count = step.source_count;
  for (std::size_t i = 0; i < step.source_count; ++i)
    call.sources[i] = resolve_source(step.sources[i], workspace, in);
  return call;
}

void run_address_step(const Step& step, Arithmetic arithmetic, Workspace& workspace, const InputBatch& in,
                      int count) {
  const DefaultMode mode;
  if (step.operation == Operation::load_address) {
    const Operand source = resolve_source(step.sources[0], workspace, in);
    for (int lane = 0; lane < count; ++lane) {
      float value = negated(source.component[0][static_cast<std::size_t>(lane) * source.stride], source.sign);
      if (arithmetic == Arithmetic::nv20 && std::fpclassify(value) == FP_SUBNORMAL) value = 0;
      value = std::floor(value);
      const bool in_reach = value >= -4096.0f && value <= 4096.0f;
      workspace.address[lane] = in_reach ? static_cast<std::int32_t>(value) : kOutOfRange;
    }
    return;
  }
  for (int lane = 0; lane < count; ++lane) {
    const std::int32_t index = workspace.address[lane] + step.constant_offset;
    const Vec4 value = index >= 0 && index < isa::kVertexConstants
                           ? workspace.constants[static_cast<std::size_t>(index)]
                           : Vec4{};
    for (std::size_t component = 0; component < 4; ++component)
      workspace.scratch[component][lane] = value[component];
  }
}

void run_scalar(const Call& call, Arithmetic arithmetic, int first, int last) {
  const DefaultMode mode;
  for (int lane = first; lane < last; ++lane) {
    std::array<Vec4, 3> sources{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t component = 0; component < 4; ++component)
        if (const float* values = call.sources[i].component[component])
          sources[i][component] =
              negated(values[static_cast<std::size_t>(lane) * call.sources[i].stride], call.sources[i].sign);
    const Vec4 result = evaluate(call.operation, arithmetic, sources);
    for (std::size_t k = 0; k < call.component_count; ++k)
      call.destination[call.components[k] * kBatch + static_cast<std::size_t>(lane)] =
          result[call.components[k]];
  }
}

}  // namespace splatscope::vertex
