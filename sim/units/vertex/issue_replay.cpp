#include "sim/units/vertex/issue_replay.h"

#include <algorithm>

namespace splatscope::sim {

IssueReplay::IssueReplay(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec,
                         std::size_t most_states)
    : rest_(slots, spec), most_states_(most_states) {
  at_ = number(rest_);
}

void IssueReplay::rest() {
  make_room();
  at_ = number(rest_);
}

// Numbers of states hold good until here.
void IssueReplay::make_room() {
  if (entries_.size() < most_states_ && passed_.size() < 4 * most_states_) return;
  const IssueLogic here = logic();
  table_.clear();
  entries_.clear();
  passed_.clear();
  at_ = number(here);
}

IssueReplay::Number IssueReplay::number(const IssueLogic& logic) {
  const auto [found, is_new] = table_.try_emplace(logic, static_cast<Number>(entries_.size()));
  if (is_new) entries_.push_back({&*found, {}, kUnknown, -1, kUnknown});
  return found->second;
}

IssueReplay::NextEnd IssueReplay::next_end() {
  if (logic().held() == 0) return {};
  if (entries_[at_].after_end == kUnknown) {
    make_room();
    IssueLogic going = logic();
    NextEnd next;
    for (next.cycles = 0; !next.issued.is_last; ++next.cycles) {
      if (const auto issued = going.issue()) next.issued = *issued;
    }
    const Number after = number(going);
    entries_[at_].next_end = next;
    entries_[at_].after_end = after;
  }
  return entries_[at_].next_end;
}

void IssueReplay::pass_next_end() {
  next_end();
  at_ = entries_[at_].after_end;
}

void IssueReplay::pass(Cycle cycles) {
  // Without a vertex every countdown comes to its end; with one, a vertex ends sooner or later.
  if (logic().held() == 0) cycles = std::min(cycles, kLongest);
  if (cycles == 0 || logic().is_at_rest()) return;
  make_room();
  const std::uint64_t key = at_ * kLongest + cycles - 1;
  const bool is_short = cycles <= kLongest;
  if (is_short) {
    if (const auto known = passed_.find(key); known != passed_.end()) {
      at_ = known->second;
      return;
    }
  }
  IssueLogic going = logic();
  for (Cycle i = 0; i < cycles; ++i) going.issue();
  at_ = number(going);
  if (is_short) passed_.emplace(key, at_);
}

int IssueReplay::take() {
  if (entries_[at_].after_taking == kUnknown) {
    make_room();
    IssueLogic going = logic();
    const int thread = going.take();
    const Number after = number(going);
    entries_[at_].taken_by = thread;
    entries_[at_].after_taking = after;
  }
  const int thread = entries_[at_].taken_by;
  at_ = entries_[at_].after_taking;
  return thread;
}

}  // namespace splatscope::sim
