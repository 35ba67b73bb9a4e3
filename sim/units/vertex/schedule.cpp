#include "sim/units/vertex/schedule.h"

#include <algorithm>
#include <bit>

namespace splatscope::sim {
namespace {

// The register of the lowest component in the mask.
std::size_t register_of(ComponentMask mask) {
  return static_cast<std::size_t>(std::countr_zero(mask)) / 4;
}

}  // namespace

IssueLogic::IssueLogic(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec)
    : slots_(&slots),
      vector_latency_(static_cast<Cycle>(spec.vector_latency)),
      scalar_latency_(static_cast<Cycle>(spec.scalar_latency)),
      scalar_interval_(static_cast<Cycle>(spec.scalar_interval)),
      threads_(static_cast<std::size_t>(spec.threads)) {}

void IssueLogic::start(int vertices) {
  vertices_ = static_cast<std::size_t>(vertices);
  for (Thread& thread : threads_) thread = {};
  turn_ = 0;
  left_ = vertices_ * slots_->size();
  now_ = 0;
  scalar_free_ = 0;
  last_result_ = 0;
}

bool IssueLogic::can_issue(const Thread& thread, const IssueSlot& slot) const {
  if (slot.has_scalar && scalar_free_ > now_) return false;
  for (ComponentMask reads = slot.reads; reads != 0; reads &= reads - 1) {
    if (thread.ready[register_of(reads)] > now_) return false;
  }
  // Results of one register arrive in order.
  const auto in_order = [&](ComponentMask writes, Cycle latency) {
    for (; writes != 0; writes &= writes - 1) {
      if (thread.ready[register_of(writes)] > now_ + latency) return false;
    }
    return true;
  };
  return in_order(slot.vector_writes, vector_latency_) && in_order(slot.scalar_writes, scalar_latency_);
}

void IssueLogic::record(Thread& thread, ComponentMask writes, Cycle latency) {
  for (; writes != 0; writes &= writes - 1) {
    thread.ready[register_of(writes)] = now_ + latency;
  }
  last_result_ = std::max(last_result_, now_ + latency);
}

int IssueLogic::issue() {
  int issued = -1;
  for (std::size_t i = 0; i < vertices_ && issued < 0; ++i) {
    const std::size_t candidate = (turn_ + i) % vertices_;
    Thread& thread = threads_[candidate];
    if (thread.slot == slots_->size() || !can_issue(thread, (*slots_)[thread.slot])) continue;
    const IssueSlot& slot = (*slots_)[thread.slot++];
    if (slot.has_vector) record(thread, slot.vector_writes, vector_latency_);
    if (slot.has_scalar) {
      record(thread, slot.scalar_writes, scalar_latency_);
      scalar_free_ = now_ + scalar_interval_;
    }
    turn_ = (candidate + 1) % vertices_;
    --left_;
    issued = static_cast<int>(candidate);
  }
  ++now_;
  return issued;
}

std::vector<GroupSchedule> group_schedules(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec) {
  std::vector<GroupSchedule> schedules;
  IssueLogic logic(slots, spec);
  for (int vertices = 1; vertices <= spec.threads; ++vertices) {
    logic.start(vertices);
    while (!logic.done()) logic.issue();
    schedules.push_back({logic.issue_cycles(), logic.last_result()});
  }
  return schedules;
}

double clocks_per_vertex(const isa::Program& program, const Machine::Vertex& spec) {
  const auto slots = issue_slots(program, spec);
  const Cycle group =
      group_schedules(slots, spec).back().issue_cycles + static_cast<Cycle>(spec.group_start_cycles);
  return static_cast<double>(group) / spec.threads;
}

}  // namespace splatscope::sim
