#include "model/vertex/vertex_program.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "model/vertex/steps.h"

namespace splatscope::vertex {

struct VertexProgram::Decoded {
  Arithmetic arithmetic = Arithmetic::ieee;
  std::vector<Step> steps;
  std::size_t instructions = 0;
  std::vector<std::pair<std::uint16_t, Vec4>> defined;  // by `def`
  std::vector<std::uint16_t> constants_read;            // addressed directly
  int temporaries = 0;                                  // r0..r(n-1) are used
  std::array<std::uint8_t, kOutputs> written{};         // components of each output

  void prepare(std::span<const Vec4> constants, Workspace& workspace, OutputBatch& out) const;

  template <typename RunCall>
  void run(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out, int count,
           RunCall run_call) const;
};

void VertexProgram::Decoded::prepare(std::span<const Vec4> constants, Workspace& workspace,
                                     OutputBatch& out) const {
  const auto given = std::min<std::size_t>(constants.size(), kConstants);
  std::copy_n(constants.begin(), given, workspace.constants.begin());
  std::fill(workspace.constants.begin() + static_cast<std::ptrdiff_t>(given), workspace.constants.end(),
            Vec4{});
  for (const auto& [index, value] : defined) workspace.constants[index] = value;
  for (const std::uint16_t index : constants_read)
    for (std::size_t component = 0; component < 4; ++component)
      std::fill_n(workspace.broadcast[index][component], kBroadcast, workspace.constants[index][component]);
  std::fill_n(workspace.temporaries[0][0], temporaries * 4 * kBatch, 0.0f);
  std::fill_n(workspace.address, kBatch, 0);
  for (std::size_t output = 0; output < kOutputs; ++output)
    for (std::size_t component = 0; component < 4; ++component)
      if (!(written[output] & (1u << component)))
        std::fill_n(out.o[output][component], kBatch, output == oD0 ? 1.0f : 0.0f);
}

template <typename RunCall>
void VertexProgram::Decoded::run(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                                 int count, RunCall run_call) const {
  Workspace workspace;
  prepare(constants, workspace, out);
  for (const Step& step : steps) {
    if (step.operation == Operation::load_address || step.operation == Operation::gather_constant)
      run_address_step(step, workspace, in, count);
    else
      run_call(resolve(step, workspace, in, out));
  }
}

VertexProgram::VertexProgram(const isa::Program& program, Arithmetic arithmetic)
    : decoded_(std::make_unique<Decoded>()) {
  decoded_->arithmetic = arithmetic;
  decoded_->steps = make_steps(program);
  decoded_->instructions = program.instructions.size();
  for (const isa::Definition& definition : program.definitions)
    decoded_->defined.emplace_back(definition.index, definition.values);
  const auto use = [&](Place place, std::uint16_t index) {
    if (place == Place::temporary) decoded_->temporaries = std::max(decoded_->temporaries, index + 1);
    if (place == Place::constant && std::ranges::count(decoded_->constants_read, index) == 0)
      decoded_->constants_read.push_back(index);
  };
  for (const Step& step : decoded_->steps) {
    use(step.destination_place, step.destination_index);
    for (std::size_t i = 0; i < step.source_count; ++i) use(step.sources[i].place, step.sources[i].index);
    if (step.destination_place == Place::output) decoded_->written[step.destination_index] |= step.mask;
  }
}

std::vector<VertexState> VertexProgram::trace(std::span<const Vec4> constants, const InputBatch& in) const {
  const auto workspace = std::make_unique<Workspace>();
  const auto out = std::make_unique<OutputBatch>();
  std::fill_n(workspace->temporaries[0][0], kTemporaries * 4 * kBatch, 0.0f);
  std::fill_n(out->o[0][0], kOutputs * 4 * kBatch, 0.0f);
  decoded_->prepare(constants, *workspace, *out);
  const auto state = [&] {
    VertexState result;
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t r = 0; r < kTemporaries; ++r)
        result.temporaries[r][c] = workspace->temporaries[r][c][0];
      for (std::size_t o = 0; o < kOutputs; ++o) result.outputs[o][c] = out->o[o][c][0];
    }
    result.address = workspace->address[0];
    return result;
  };
  std::vector<VertexState> states{state()};
  auto step = decoded_->steps.begin();
  for (std::size_t instruction = 0; instruction < decoded_->instructions; ++instruction) {
    for (; step != decoded_->steps.end() && step->instruction == instruction; ++step) {
      if (step->operation == Operation::load_address || step->operation == Operation::gather_constant)
        run_address_step(*step, *workspace, in, 1);
      else
        vertex::run_scalar(resolve(*step, *workspace, in, *out), decoded_->arithmetic, 0, 1);
    }
    states.push_back(state());
  }
  return states;
}

VertexProgram::~VertexProgram() = default;
VertexProgram::VertexProgram(VertexProgram&&) noexcept = default;
VertexProgram& VertexProgram::operator=(VertexProgram&&) noexcept = default;

void VertexProgram::run(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                        int count) const {
  decoded_->run(constants, in, out, count, [&](const Call& call) {
    decoded_->arithmetic == Arithmetic::ieee ? run_simd_ieee(call, count) : run_simd_nv20(call, count);
  });
}

void VertexProgram::run_scalar(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                               int count) const {
  decoded_->run(constants, in, out, count,
                [&](const Call& call) { vertex::run_scalar(call, decoded_->arithmetic, 0, count); });
}

}  // namespace splatscope::vertex
