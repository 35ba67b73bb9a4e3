#include "model/vertex/groups.h"

namespace splatscope::vertex {
namespace {

// The same for all sources, after the swizzle.
unsigned lanes_read(const Step& step) {
  switch (step.operation) {
    case Operation::move:
    case Operation::add:
    case Operation::multiply:
    case Operation::multiply_add:
    case Operation::minimum:
    case Operation::maximum:
    case Operation::less:
    case Operation::greater_equal:
      return step.mask;
    case Operation::dot3:
      return 0x7;
    case Operation::reciprocal:
    case Operation::reciprocal_sqrt:
      return 0x1;
    default:
      return 0xf;
  }
}

class Planner {
 public:
  explicit Planner(unsigned grouped_inputs) {
    temporaries_.fill({});
    outputs_.fill({});
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      inputs_[i] = (grouped_inputs >> i & 1u) != 0 ? Held{0xf, 0} : Held{};
  }

  void add(const Step& step) {
    const bool grouped = can_be_grouped(step);
    if (!grouped)
      for (std::size_t i = 0; i < step.source_count; ++i)
        spread_source(step.sources[i], components_read(step, step.sources[i]));
    planned_.push_back({step, grouped});
    if (step.destination_place == Place::temporary || step.destination_place == Place::output)
      held(step.destination_place, step.destination_index).write(step.mask, grouped);
  }

  std::vector<PlannedStep> finish() {
    for (std::uint16_t output = 0; output < kOutputs; ++output) {
      StepSource source;
      source.place = Place::output;
      source.index = output;
      spread_source(source, outputs_[output].grouped);
    }
    return std::move(planned_);
  }

 private:
  // Which components of a register are up to date, a lane a group and a lane a vertex.
  struct Held {
    unsigned grouped = 0, each = 0xf;
    void write(unsigned mask, bool to_grouped) {
      grouped = to_grouped ? grouped | mask : grouped & ~mask;
      each = to_grouped ? each & ~mask : each | mask;
    }
  };

  Held& held(Place place, std::size_t index) {
    return place == Place::temporary ? temporaries_[index]
           : place == Place::input   ? inputs_[index]
                                     : outputs_[index];
  }

  bool can_be_grouped(const Step& step) {
    if (step.destination_place != Place::temporary && step.destination_place != Place::output) return false;
    for (std::size_t i = 0; i < step.source_count; ++i) {
      const StepSource& source = step.sources[i];
      if (source.place == Place::constant) continue;
      if (source.place == Place::scratch) return false;
      const unsigned needed = components_read(step, source);
      if ((needed & ~held(source.place, source.index).grouped) != 0) return false;
    }
    return true;
  }

  void spread_source(const StepSource& source, unsigned components) {
    if (source.place == Place::constant || source.place == Place::scratch) return;
    Held& from = held(source.place, source.index);
    const unsigned missing = components & ~from.each;
    if (missing == 0) return;
    Step step;
    step.operation = Operation::spread;
    step.destination_place = source.place;
    step.destination_index = source.index;
    step.mask = static_cast<std::uint8_t>(missing);
    planned_.push_back({step, false});
    from.each |= missing;
  }

  std::array<Held, isa::kVertexTemporaries> temporaries_;
  std::array<Held, isa::kVertexInputs> inputs_;
  std::array<Held, kOutputs> outputs_;
  std::vector<PlannedStep> planned_;
};

}  // namespace

unsigned components_read(const Step& step, const StepSource& source) {
  const unsigned lanes = lanes_read(step);
  unsigned components = 0;
  for (std::size_t lane = 0; lane < 4; ++lane)
    if ((lanes >> lane & 1u) != 0) components |= 1u << source.swizzle[lane];
  return components;
}

std::vector<PlannedStep> plan_groups(const std::vector<Step>& steps, unsigned grouped_inputs) {
  Planner planner(grouped_inputs);
  for (const Step& step : steps) planner.add(step);
  return planner.finish();
}

}  // namespace splatscope::vertex
