#include "model/vertex/vertex_program.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "model/number/significand.h"
#include "model/vertex/groups.h"
#include "model/vertex/processor_mode.h"
#include "model/vertex/steps.h"

namespace splatscope::vertex {
namespace {

constexpr std::size_t kMostPlans = 8;  // kept for sets of grouped inputs

}  // namespace

void NextVertices::prefetch(std::size_t first, std::size_t count) const {
  for (std::size_t i = first; i < std::min(first + count, numbers.size()); ++i)
    hwy::Prefetch(buffer.data() + std::size_t{numbers[i]} * stride);
}

struct VertexProgram::Decoded {
  Arithmetic arithmetic = Arithmetic::ieee;
  int reciprocal_bits = 24;
  std::vector<Step> steps;
  std::size_t instructions = 0;
  bool addresses = false;                               // some constant by a0
  std::vector<std::pair<std::uint16_t, Vec4>> defined;  // by `def`
  std::vector<std::uint16_t> constants_read;            // addressed directly
  std::vector<std::uint16_t> inputs_read;
  std::vector<std::uint16_t>
      temporaries_read_first;                    // before all of what is read is written: they start at 0
  std::array<std::uint8_t, kOutputs> written{};  // components of each output

  void use(const Step& step, std::array<std::uint8_t, isa::kVertexTemporaries>& temporaries_written);
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
                                 std::array<std::uint8_t, isa::kVertexTemporaries>& temporaries_written) {
  for (std::size_t i = 0; i < step.source_count; ++i) {
    const StepSource& source = step.sources[i];
    if (source.place == Place::constant) add_once(constants_read, source.index);
    if (source.place == Place::input) add_once(inputs_read, source.index);
    if (source.place == Place::temporary &&
        (components_read(step, source) & ~unsigned{temporaries_written[source.index]}) != 0)
      add_once(temporaries_read_first, source.index);
  }
  const std::uint16_t destination = step.destination_index;
  if (step.destination_place == Place::output) written[destination] |= step.mask;
  if (step.destination_place == Place::temporary) temporaries_written[destination] |= step.mask;
}

namespace {

// The registers of a batch: a lane a vertex, or a lane a group.
struct Lanes {
  Lanes(const InputBatch& inputs, OutputBatch& outputs) : in(inputs), out(outputs) {}
  const InputBatch& in;
  OutputBatch& out;
  Workspace workspace;
};

bool any_special(const float (&components)[4][kBatch], int count) {
  const std::size_t lanes = (static_cast<std::size_t>(count) + kBroadcast - 1) / kBroadcast * kBroadcast;
  return std::ranges::any_of(components,
                             [&](const auto& component) { return holds_special(component, lanes); });
}

}  // namespace

// The registers of a batch, and the steps with their places in them.
class VertexProgram::Execution {
 public:
  Execution(const Decoded& program, std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out);

  // Grouped inputs, and where to spread them.
  void enable_groups(const InputBatch& grouped_in, InputBatch& in);

  // Sets what a batch starts with.
  void begin(int count, unsigned grouped_inputs = 0);

  // A few of `next` are asked for at each step: more at once, and the processor would wait for them.
  template <typename RunCall>
  void run(int count, unsigned grouped_inputs, const NextVertices& next, RunCall run_call) {
    begin(count, grouped_inputs);
    const std::size_t steps = plan_->calls.size(),
                      at_once = next.numbers.size() / std::max<std::size_t>(steps, 1) + 1;
    for (std::size_t i = 0; i < steps; ++i) {
      next.prefetch(i * at_once, at_once);
      run_step(i, count, run_call);
    }
  }

  // run_call(call, number of lanes)
  template <typename RunCall>
  void run_step(std::size_t i, int count, RunCall run_call) {
    const auto& [step, grouped] = plan_->steps[i];
    const Call& call = plan_->calls[i];
    const int lanes = grouped ? count / kGroup : count;
    if (is_address_step(step)) {
      run_address_step(step, program_.arithmetic, each_.workspace, each_.in, count);
    } else if (step.operation == Operation::spread) {
      run_spread(call, count);
    } else {
      run_call(call, lanes);
    }
    if (program_.reciprocal_bits < 24) round_reciprocal(call, lanes);
  }

  Workspace& workspace() { return each_.workspace; }

 private:
  struct Groups {
    Lanes lanes;
    std::unique_ptr<OutputBatch> out;
    InputBatch& spread_in;
  };

  void set_constants(std::span<const Vec4> constants, Workspace& workspace) const;
  struct Plan {
    std::vector<PlannedStep> steps;
    std::vector<Call> calls;  // one a step
  };
  const Plan& plan_for(unsigned grouped_inputs);
  Call resolve_spread(const Step& step);
  static void run_spread(const Call& call, int count);
  void round_reciprocal(const Call& call, int count) const;

  const Decoded& program_;
  Lanes each_;
  std::unique_ptr<Groups> groups_;
  std::map<unsigned, Plan> plans_;  // by grouped inputs: most batches come with one of a few sets
  const Plan* plan_ = nullptr;      // of the batch
};

VertexProgram::Execution::Execution(const Decoded& program, std::span<const Vec4> constants,
                                    const InputBatch& in, OutputBatch& out)
    : program_(program), each_{in, out} {
  set_constants(constants, each_.workspace);
  for (std::size_t output = 0; output < kOutputs; ++output)
    for (std::size_t component = 0; component < 4; ++component)
      if (!(program.written[output] & (1u << component)))
        std::fill_n(out.o[output][component], kBatch, output == oD0 ? 1.0f : 0.0f);
}

void VertexProgram::Execution::set_constants(std::span<const Vec4> constants, Workspace& workspace) const {
  const auto given = std::min<std::size_t>(constants.size(), isa::kVertexConstants);
  std::copy_n(constants.begin(), given, workspace.constants.begin());
  for (const auto& [index, value] : program_.defined) workspace.constants[index] = value;
  for (const std::uint16_t index : program_.constants_read) {
    const Vec4& constant = workspace.constants[index];
    workspace.special.constants[index] = std::ranges::any_of(constant, is_special);
    for (std::size_t component = 0; component < 4; ++component)
      std::fill_n(workspace.broadcast[index][component], kBroadcast, constant[component]);
  }
}

void VertexProgram::Execution::enable_groups(const InputBatch& grouped_in, InputBatch& in) {
  auto out = std::make_unique_for_overwrite<OutputBatch>();
  OutputBatch& grouped_out = *out;
  groups_.reset(new Groups{{grouped_in, grouped_out}, std::move(out), in});
  set_constants(each_.workspace.constants, groups_->lanes.workspace);
}

const VertexProgram::Execution::Plan& VertexProgram::Execution::plan_for(unsigned grouped_inputs) {
  const auto found = plans_.find(grouped_inputs);
  if (found != plans_.end()) return found->second;
  if (plans_.size() == kMostPlans) plans_.clear();
  Plan& plan = plans_[grouped_inputs];
  if (grouped_inputs != 0) {
    plan.steps = plan_groups(program_.steps, grouped_inputs);
  } else {
    for (const Step& step : program_.steps) plan.steps.push_back({step, false});
  }
  for (const auto& [step, grouped] : plan.steps) {
    Lanes& lanes = grouped ? groups_->lanes : each_;
    plan.calls.push_back(step.operation == Operation::spread
                             ? resolve_spread(step)
                             : resolve(step, lanes.workspace, lanes.in, lanes.out));
  }
  return plan;
}

Call VertexProgram::Execution::resolve_spread(const Step& step) {
  Call call;
  call.operation = Operation::spread;
  for (std::uint8_t component = 0; component < 4; ++component)
    if (step.mask & (1u << component)) call.components[call.component_count++] = component;
  const std::size_t index = step.destination_index;
  const auto between = [&](const float(&from)[4][kBatch], bool& from_special, float(&to)[4][kBatch],
                           bool& to_special) {
    call.source_count = 1;
    for (std::size_t component = 0; component < 4; ++component)
      call.sources[0].component[component] = from[component];
    call.sources[0].special = &from_special;
    call.destination = to[0];
    call.special = &to_special;
  };
  Lanes& grouped = groups_->lanes;
  SpecialRegisters &from = grouped.workspace.special, &to = each_.workspace.special;
  if (step.destination_place == Place::temporary) {
    between(grouped.workspace.temporaries[index], from.temporaries[index], each_.workspace.temporaries[index],
            to.temporaries[index]);
  } else if (step.destination_place == Place::input) {
    between(grouped.in.v[index], from.inputs[index], groups_->spread_in.v[index], to.inputs[index]);
  } else {
    between(grouped.out.o[index], from.outputs, each_.out.o[index], to.outputs);
  }
  return call;
}

void VertexProgram::Execution::run_spread(const Call& call, int count) {
  for (std::size_t k = 0; k < call.component_count; ++k) {
    const std::size_t component = call.components[k];
    spread(call.sources[0].component[component], call.destination + component * kBatch, count);
  }
  *call.special |= *call.sources[0].special;
}

void VertexProgram::Execution::begin(int count, unsigned grouped_inputs) {
  plan_ = &plan_for(grouped_inputs);
  Workspace& workspace = each_.workspace;
  for (const std::uint16_t index : program_.temporaries_read_first)
    std::fill_n(workspace.temporaries[index][0], 4 * kBatch, 0.0f);
  if (program_.addresses) std::fill_n(workspace.address, kBatch, 0);
  if (program_.arithmetic == Arithmetic::ieee) return;
  workspace.special.temporaries = {};
  if (grouped_inputs != 0) groups_->lanes.workspace.special.temporaries = {};
  for (const std::uint16_t index : program_.inputs_read) {
    const bool grouped = (grouped_inputs >> index & 1u) != 0;
    workspace.special.inputs[index] = !grouped && any_special(each_.in.v[index], count);
    if (grouped)
      groups_->lanes.workspace.special.inputs[index] =
          any_special(groups_->lanes.in.v[index], count / kGroup);
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
  std::array<std::uint8_t, isa::kVertexTemporaries> temporaries_written{};
  for (const Step& step : decoded_->steps) decoded_->use(step, temporaries_written);
  decoded_->addresses = std::ranges::any_of(decoded_->steps, is_address_step);
}

std::vector<VertexState> VertexProgram::trace(std::span<const Vec4> constants, const InputBatch& in) const {
  const auto out = std::make_unique<OutputBatch>();
  std::fill_n(out->o[0][0], kOutputs * 4 * kBatch, 0.0f);
  const auto execution = std::make_unique<Execution>(*decoded_, constants, in, *out);
  Workspace& workspace = execution->workspace();
  // A run writes registers before it reads them; here they are looked at before.
  for (auto& temporary : workspace.temporaries)
    for (auto& component : temporary) component[0] = 0;
  const auto state = [&] {
    VertexState result;
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t r = 0; r < isa::kVertexTemporaries; ++r)
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
      execution->run_step(step, 1, [&](const Call& call, int count) {
        vertex::run_scalar(call, decoded_->arithmetic, 0, count);
      });
    states.push_back(state());
  }
  return states;
}

VertexProgram::~VertexProgram() = default;
VertexProgram::VertexProgram(VertexProgram&&) noexcept = default;

unsigned VertexProgram::inputs_read() const {
  unsigned read = 0;
  for (const std::uint16_t index : decoded_->inputs_read) read |= 1u << index;
  return read;
}

void VertexProgram::run_batch(Execution& execution, int count, unsigned grouped_inputs,
                              const NextVertices& next) const {
  if (decoded_->arithmetic == Arithmetic::ieee) {
    execution.run(count, grouped_inputs, next, run_simd_ieee);
  } else {
    const Nv20Mode mode;
    execution.run(count, grouped_inputs, next, run_simd_nv20);
  }
}

void VertexProgram::run(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                        int count) const {
  run_batch(*std::make_unique<Execution>(*decoded_, constants, in, out), count, 0, {});
}

void VertexProgram::run_scalar(std::span<const Vec4> constants, const InputBatch& in, OutputBatch& out,
                               int count) const {
  const auto execution = std::make_unique<Execution>(*decoded_, constants, in, out);
  execution->run(count, 0, {}, [&](const Call& call, int lanes) {
    vertex::run_scalar(call, decoded_->arithmetic, 0, lanes);
  });
}

struct VertexProgram::Bound::State {
  State(const VertexProgram& bound, std::span<const Vec4> constants)
      : program(bound), execution(*bound.decoded_, constants, in, out) {
    execution.enable_groups(grouped_in, in);
  }
  const VertexProgram& program;
  InputBatch in, grouped_in;
  OutputBatch out;
  Execution execution;
};

VertexProgram::Bound::Bound(const VertexProgram& program, std::span<const Vec4> constants)
    : state_(std::make_unique<State>(program, constants)) {}
VertexProgram::Bound::~Bound() = default;

InputBatch& VertexProgram::Bound::input() {
  return state_->in;
}
InputBatch& VertexProgram::Bound::grouped_input() {
  return state_->grouped_in;
}
const OutputBatch& VertexProgram::Bound::output() const {
  return state_->out;
}
void VertexProgram::Bound::run(int count, unsigned grouped_inputs, const NextVertices& next) {
  state_->program.run_batch(state_->execution, count, grouped_inputs & state_->program.inputs_read(), next);
}

}  // namespace splatscope::vertex
