#include "model/vertex/vertex_program.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "model/number/significand.h"
#include "model/vertex/processor_mode.h"
#include "model/vertex/steps.h"

namespace splatscope::vertex {

struct VertexProgram::Decoded {
  Arithmetic arithmetic = Arithmetic::ieee;
  int reciprocal_bits = 24;
  std::vector<Step> steps;
  std::size_t instructions = 0;
  std::vector<std::pair<std::uint16_t, Vec4>> defined;  // by `def`
  std::vector<std::uint16_t> constants_read;            // addressed directly
  std::vector<std::uint16_t> inputs_read;
  std::vector<std::uint16_t>
      temporaries_read_first;                    // before all of what is read is written: they start at 0
  std::array<std::uint8_t, kOutputs> written{};  // components of each output

  void use(const Step& step, std::array<std::uint8_t, kTemporaries>& temporaries_written);
};

namespace {

bool is_address_step(const Step& step) {
  return step.operation == Operation::load_address || step.operation == Operation::gather_constant;
}

void add_once(std::vector<std::uint16_t>& numbers, std::uint16_t number) {
  if (std::ranges::count(numbers, number) == 0) numbers.push_back(number);
}

}  // namespace

void VertexProgram::Decoded::use(const Step& step,
                                 std::array<std::uint8_t, kTemporaries>& temporaries_written) {
  for (std::size_t i = 0; i < step.source_count; ++i) {
    const StepSource& source = step.sources[i];
    if (source.place == Place::constant) add_once(constants_read, source.index);
    if (source.place == Place::input) add_once(inputs_read, source.index);
    if (source.place == Place::temporary && temporaries_written[source.index] != 0xf)
      add_once(temporaries_read_first, source.index);
  }
  const std::uint16_t destination = step.destination_index;
  if (step.destination_place == Place::output) written[destination] |= step.mask;
  if (step.destination_place == Place::temporary) temporaries_written[destination] |= step.mask;
}

// The registers of a batch, and the steps with their places in them.
class VertexProgram::Execution {
 public:
  Execution(const Decoded& program, std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out);

  // Sets what a batch starts with.
  void begin(int count);

  template <typename RunCall>
  void run(int count, RunCall run_call) {
    begin(count);
    for (std::size_t i = 0; i < program_.steps.size(); ++i) run_step(i, count, run_call);
  }

  template <typename RunCall>
  void run_step(std::size_t i, int count, RunCall run_call) {
    const Step& step = program_.steps[i];
    if (is_address_step(step))
      run_address_step(step, workspace_, in_, count);
    else
      run_call(calls_[i]);
    if (program_.reciprocal_bits < 24) round_reciprocal(calls_[i], count);
  }

  const Workspace& workspace() const { return workspace_; }

 private:
  void round_reciprocal(const Call& call, int count) const;

  const Decoded& program_;
  const InputBatch& in_;
  Workspace workspace_;
  std::vector<Call> calls_;  // one a step
};

VertexProgram::Execution::Execution(const Decoded& program, std::span<const Vec4> constants,
                                    const InputBatch& in, OutputBatch& out)
    : program_(program), in_(in) {
  const auto given = std::min<std::size_t>(constants.size(), kConstants);
  std::copy_n(constants.begin(), given, workspace_.constants.begin());
  for (const auto& [index, value] : program.defined) workspace_.constants[index] = value;
  for (const std::uint16_t index : program.constants_read) {
    const Vec4& constant = workspace_.constants[index];
    workspace_.special.constants[index] = std::ranges::any_of(constant, is_special);
    for (std::size_t component = 0; component < 4; ++component)
      std::fill_n(workspace_.broadcast[index][component], kBroadcast, constant[component]);
  }
  for (std::size_t output = 0; output < kOutputs; ++output)
    for (std::size_t component = 0; component < 4; ++component)
      if (!(program.written[output] & (1u << component)))
        std::fill_n(out.o[output][component], kBatch, output == oD0 ? 1.0f : 0.0f);
  for (const Step& step : program.steps) calls_.push_back(resolve(step, workspace_, in, out));
}

void VertexProgram::Execution::begin(int count) {
  for (const std::uint16_t index : program_.temporaries_read_first)
    std::fill_n(workspace_.temporaries[index][0], 4 * kBatch, 0.0f);
  std::fill_n(workspace_.address, kBatch, 0);
  if (program_.arithmetic == Arithmetic::ieee) return;
  workspace_.special.temporaries = {};
  const std::size_t lanes = (static_cast<std::size_t>(count) + kBroadcast - 1) / kBroadcast * kBroadcast;
  for (const std::uint16_t index : program_.inputs_read) {
    bool special = false;
    for (const auto& component : in_.v[index]) special |= holds_special(component, lanes);
    workspace_.special.inputs[index] = special;
  }
}

void VertexProgram::Execution::round_reciprocal(const Call& call, int count) const {
  if (call.operation != Operation::reciprocal && call.operation != Operation::reciprocal_sqrt) return;
  for (std::size_t i = 0; i < call.component_count; ++i) {
    float* const values = call.destination + call.components[i] * kBatch;
    for (int vertex = 0; vertex < count; ++vertex)
      values[vertex] = rounded_significand(values[vertex], program_.reciprocal_bits);
  }
}

VertexProgram::VertexProgram(const isa::Program& program, Arithmetic arithmetic, int reciprocal_bits)
    : decoded_(std::make_unique<Decoded>()) {
  decoded_->arithmetic = arithmetic;
  decoded_->reciprocal_bits = reciprocal_bits;
  decoded_->steps = make_steps(program);
  decoded_->instructions = program.instructions.size();
  for (const isa::Definition& definition : program.definitions)
    decoded_->defined.emplace_back(definition.index, definition.values);
  std::array<std::uint8_t, kTemporaries> temporaries_written{};
  for (const Step& step : decoded_->steps) decoded_->use(step, temporaries_written);
}

std::vector<VertexState> VertexProgram::trace(std::span<const Vec4> constants, const InputBatch& in) const {
  const auto out = std::make_unique<OutputBatch>();
  std::fill_n(out->o[0][0], kOutputs * 4 * kBatch, 0.0f);
  const auto execution = std::make_unique<Execution>(*decoded_, constants, in, *out);
  const auto state = [&] {
    const Workspace& workspace = execution->workspace();
    VertexState result;
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t r = 0; r < kTemporaries; ++r)
        result.temporaries[r][c] = workspace.temporaries[r][c][0];
      for (std::size_t o = 0; o < kOutputs; ++o) result.outputs[o][c] = out->o[o][c][0];
    }
    result.address = workspace.address[0];
    return result;
  };
  execution->begin(1);
  std::vector<VertexState> states{state()};
  std::size_t step = 0;
  for (std::size_t instruction = 0; instruction < decoded_->instructions; ++instruction) {
    for (; step < decoded_->steps.size() && decoded_->steps[step].instruction == instruction; ++step)
      execution->run_step(step, 1,
                          [&](const Call& call) { vertex::run_scalar(call, decoded_->arithmetic, 0, 1); });
    states.push_back(state());
  }
  return states;
}

VertexProgram::~VertexProgram() = default;
VertexProgram::VertexProgram(VertexProgram&&) noexcept = default;
VertexProgram& VertexProgram::operator=(VertexProgram&&) noexcept = default;

bool VertexProgram::reads(int input) const {
  return std::ranges::count(decoded_->inputs_read, input) != 0;
}

void VertexProgram::run_batch(Execution& execution, int count) const {
  if (decoded_->arithmetic == Arithmetic::ieee) {
    execution.run(count, [&](const Call& call) { run_simd_ieee(call, count); });
  } else {
    const Nv20Mode mode;
    execution.run(count, [&](const Call& call) { run_simd_nv20(call, count); });
  }
}

void VertexProgram::run(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                        int count) const {
  run_batch(*std::make_unique<Execution>(*decoded_, constants, in, out), count);
}

void VertexProgram::run_scalar(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                               int count) const {
  std::make_unique<Execution>(*decoded_, constants, in, out)->run(count, [&](const Call& call) {
    vertex::run_scalar(call, decoded_->arithmetic, 0, count);
  });
}

struct VertexProgram::Bound::State {
  State(const VertexProgram& bound, std::span<const Vec4> constants)
      : program(bound), execution(*bound.decoded_, constants, in, out) {}
  const VertexProgram& program;
  InputBatch in{};
  OutputBatch out;
  Execution execution;
};

VertexProgram::Bound::Bound(const VertexProgram& program, std::span<const Vec4> constants)
    : state_(std::make_unique<State>(program, constants)) {}
VertexProgram::Bound::~Bound() = default;
VertexProgram::Bound::Bound(Bound&&) noexcept = default;
VertexProgram::Bound& VertexProgram::Bound::operator=(Bound&&) noexcept = default;

InputBatch& VertexProgram::Bound::input() {
  return state_->in;
}
const OutputBatch& VertexProgram::Bound::output() const {
  return state_->out;
}
void VertexProgram::Bound::run(int count) {
  state_->program.run_batch(state_->execution, count);
}

}  // namespace splatscope::vertex
