#include "sim/units/vertex/vertex_unit.h"

#include <algorithm>

namespace splatscope::sim {

VertexUnit::VertexUnit(std::string name, Completion& completion, const Machine::Vertex& spec,
                       const std::vector<VertexSchedule>& schedules)
    : DrawUnit(std::move(name), completion), spec_(spec), schedules_(schedules) {
  for (const VertexSchedule& schedule : schedules) logics_.emplace_back(schedule.slots, spec);
}

void VertexUnit::connect(Channel<VertexGroup>& in, Channel<VertexGroup>& out) {
  in_ = &in;
  out_ = &out;
}

// Its one item is the end of the draw: which unit gets how many groups is found on the way.
std::uint64_t VertexUnit::start(const DrawJob& job) {
  return job.work->shaded_vertices.empty() ? 0 : 1;
}

bool VertexUnit::retire(Cycle now) {
  if (results_.empty() || results_.front().at > now || !out_->can_push(now)) return false;
  const VertexGroup group = results_.front().group;
  results_.pop_front();
  event(now, group.number);
  out_->push(now, group);
  return true;
}

bool VertexUnit::take(Cycle now) {
  if (next_start_ > now || results_.size() == kInPipeline || !in_->can_pop(now)) return false;
  const VertexGroup group = in_->pop(now);
  if (group.vertices == 0) {
    item_done(now);
    return true;
  }
  const VertexSchedule& schedule = schedules_[job().vertex_program];
  ++groups_;
  vertices_ += group.vertices;
  slots_ += group.vertices * schedule.slots.size();
  event(now, ~std::uint64_t{group.number});
  if (domain().scheduler() == Scheduler::referee) {
    issuing_ = &logics_[job().vertex_program];
    issuing_->start(static_cast<int>(group.vertices));
    issue_start_ = now;
    next_start_ = kNever;
    results_.push_back({group, kNever});
    return true;
  }
  const GroupSchedule& timing = schedule.groups[group.vertices - 1];
  next_start_ = now + timing.issue_cycles + static_cast<Cycle>(spec_.group_start_cycles);
  results_.push_back({group, now + timing.result_cycles});
  return true;
}

// The referee's: one cycle of the issue logic.
void VertexUnit::issue_cycle() {
  issuing_->issue();
  if (!issuing_->done()) return;
  next_start_ = issue_start_ + issuing_->issue_cycles() + static_cast<Cycle>(spec_.group_start_cycles);
  results_.back().at = issue_start_ + issuing_->last_result();
  issuing_ = nullptr;
}

Step VertexUnit::advance(Cycle now) {
  const bool retired = retire(now);
  const bool took = take(now);
  if (issuing_) issue_cycle();
  if (issuing_) return busy(now + 1);
  if (next_start_ > now) {  // a result may be due while the group behind it issues
    if (results_.empty()) return busy(next_start_);
    const Cycle due = results_.front().at;
    return busy(std::min(next_start_, due > now ? due : out_->next_free()));
  }
  if (retired || took) return busy(now + 1);
  return waiting(now);
}

// Nothing issues and nothing could be moved: why.
Step VertexUnit::waiting(Cycle now) const {
  if (results_.empty()) return nothing_to_take(in_->next_visible());
  const Cycle due = results_.front().at;
  if (due <= now) {
    const Cycle next =
        results_.size() < kInPipeline ? std::min(out_->next_free(), in_->next_visible()) : out_->next_free();
    return blocked(out_->consumer(), next);
  }
  return busy(results_.size() < kInPipeline ? std::min(due, in_->next_visible()) : due);
}

std::vector<Statistic> VertexUnit::statistics() const {
  return {{"groups", "groups", "groups of vertices taken", groups_},
          {"vertices", "vertices", "vertices shaded", vertices_},
          {"issue_slots", "slots", "instructions issued, a pair as one", slots_}};
}

std::string VertexUnit::state() const {
  return std::to_string(results_.size()) + " groups in the pipeline, next start at " +
         std::to_string(next_start_);
}

}  // namespace splatscope::sim
