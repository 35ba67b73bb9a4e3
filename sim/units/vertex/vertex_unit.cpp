#include "sim/units/vertex/vertex_unit.h"

#include <algorithm>

namespace splatscope::sim {

VertexUnit::VertexUnit(std::string name, Completion& completion, const Machine::Vertex& spec,
                       const std::vector<std::vector<IssueSlot>>& programs)
    : DrawUnit(std::move(name), completion),
      spec_(spec),
      programs_(programs),
      of_threads_(static_cast<std::size_t>(spec.threads)) {
  for (const auto& slots : programs) {
    logics_.emplace_back(slots, spec);
    replays_.emplace_back(slots, spec);
  }
}

void VertexUnit::connect(Channel<VertexNumber>& in, Channel<VertexNumber>& out) {
  in_ = &in;
  out_ = &out;
}

void VertexUnit::start(const DrawJob& job) {
  program_ = job.vertex_program;
  logics_[program_] = IssueLogic(programs_[program_], spec_);
  replays_[program_].rest();
}

// What the logic issues in the cycles up to and with this one.
void VertexUnit::issue_up_to(Cycle now) {
  if (is_referee()) {
    if (const auto issued = logics_[program_].issue()) {
      if (watcher_) show(*issued, now);
      if (issued->is_last) end(*issued, now);
    }
    coming_ = now + 1;
    return;
  }
  IssueReplay& replay = replays_[program_];
  for (;;) {
    const IssueReplay::NextEnd next = replay.next_end();
    if (next.cycles == kNever || coming_ + next.cycles > now + 1) return;
    if (watcher_) show_coming(next.cycles);
    coming_ += next.cycles;
    replay.pass_next_end();
    end(next.issued, coming_ - 1);
  }
}

void VertexUnit::show(const Issued& issued, Cycle at) {
  const IssueSlot& slot = programs_[program_][issued.slot];
  const int latency =
      std::max(slot.has_vector ? spec_.vector_latency : 0, slot.has_scalar ? spec_.scalar_latency : 0);
  watcher_->issued(*this, at, of_threads_[static_cast<std::size_t>(issued.thread)], slot,
                   at + static_cast<Cycle>(latency));
}

// What the replay is about to go past, issued once more to be seen.
void VertexUnit::show_coming(Cycle cycles) {
  IssueLogic going = logic();
  for (Cycle i = 0; i < cycles && going.held() != 0 && watcher_; ++i) {
    if (const auto issued = going.issue()) show(*issued, coming_ + i);
  }
}

void VertexUnit::end(const Issued& last, Cycle at) {
  const std::uint64_t oldest = taken_ - vertices_.size();
  Vertex& vertex = vertices_[of_threads_[static_cast<std::size_t>(last.thread)] - oldest];
  vertex.result_at = at + last.result;
  reloaded_at_ = at + 1 + static_cast<Cycle>(spec_.reload_cycles);
  event(at, vertex.number);
}

bool VertexUnit::retire(Cycle now) {
  if (vertices_.empty() || vertices_.front().result_at > now || !out_->can_push(now)) return false;
  const VertexNumber number = vertices_.front().number;
  vertices_.pop_front();
  event(now, number);
  out_->push(now, number);
  return true;
}

// When the vertex that waits can be taken, or the draw ended; kNever: not before something else happens.
Cycle VertexUnit::next_take() const {
  if (in_->empty()) return kNever;
  Cycle free = kNever;
  if (in_->front() == kEndOfDraw) {
    if (vertices_.empty()) free = reloaded_at_;
  } else if (vertices_.size() != static_cast<std::size_t>(most_vertices(spec_))) {
    const Cycle wait = logic().next_free();
    if (wait != kNever) free = coming_ - 1 + wait;
  }
  return free == kNever ? kNever : std::max(free, in_->next_visible());
}

bool VertexUnit::take(Cycle now) {
  if (next_take() > now) return false;
  const VertexNumber number = in_->pop(now);
  if (number == kEndOfDraw) {
    item_done(now);
    return true;
  }
  int thread = 0;
  if (is_referee()) {
    thread = logics_[program_].take();
  } else {
    if (watcher_) show_coming(now + 1 - coming_);
    replays_[program_].pass(now + 1 - coming_);
    thread = replays_[program_].take();
    coming_ = now + 1;
  }
  if (watcher_) watcher_->taken(*this, now, taken_, number);
  of_threads_[static_cast<std::size_t>(thread)] = taken_++;
  vertices_.push_back({number, kNever});
  slots_ += programs_[program_].size();
  event(now, ~std::uint64_t{number});
  return true;
}

// The end of a draw is taken when nothing is left to issue, to pass on or to reload.
Step VertexUnit::advance(Cycle now) {
  if (!has_work()) return idle();
  issue_up_to(now);
  const bool retired = retire(now);
  const bool took = take(now);
  return retired || took ? busy(now + 1) : waiting(now);
}

// Nothing could be moved: what goes on, or why nothing does.
Step VertexUnit::waiting(Cycle now) {
  const Cycle due = vertices_.empty() ? kNever : vertices_.front().result_at;
  const Cycle next = std::min(next_take(), due <= now ? out_->next_free() : due);
  if (logic().held() != 0) {
    if (is_referee()) return busy(now + 1);
    return busy(std::min(next, coming_ + replays_[program_].next_end().cycles - 1));
  }
  if (reloaded_at_ > now) return busy(std::min(next, reloaded_at_));
  if (vertices_.empty()) return nothing_to_take(next);
  return due <= now ? blocked(out_->consumer(), next) : busy(next);
}

std::vector<Statistic> VertexUnit::statistics(Cycle) const {
  return {{"vertices", "vertices", "vertices shaded", taken_},
          {"issue_slots", "slots", "instructions issued, a pair as one", slots_}};
}

std::string VertexUnit::state() const {
  if (!has_work()) return {};
  return std::to_string(vertices_.size()) + " vertices, " + std::to_string(logic().held()) +
         " of them issuing";
}

}  // namespace splatscope::sim
