#include "sim/units/vertex/issue_logic.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <string_view>

#include "model/error.h"

namespace splatscope::sim {
namespace {

// The register of the lowest component in the mask.
std::size_t register_of(ComponentMask mask) {
  return static_cast<std::size_t>(std::countr_zero(mask)) / 4;
}

}  // namespace

IssueLogic::IssueLogic(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec)
    : slots_(&slots),
      vector_latency_(static_cast<Countdown>(spec.vector_latency)),
      scalar_latency_(static_cast<Countdown>(spec.scalar_latency)),
      scalar_interval_(static_cast<Countdown>(spec.scalar_interval)),
      reload_cycles_(static_cast<Countdown>(spec.reload_cycles)),
      threads_(static_cast<std::size_t>(spec.threads)) {
  constexpr int kMost = std::numeric_limits<Countdown>::max() - 1;  // parameters.cpp allows less
  if (std::max({spec.vector_latency, spec.scalar_latency, spec.scalar_interval, spec.reload_cycles}) > kMost)
    throw ModelError("issue logic: latencies are counted up to " + std::to_string(kMost));
  for (Thread& thread : threads_) thread.slot = static_cast<std::uint16_t>(slots.size());
}

bool IssueLogic::can_issue(const Thread& thread) const {
  if (thread.slot == slots_->size()) return false;
  const IssueSlot& slot = (*slots_)[thread.slot];
  if (slot.has_scalar && scalar_free_ != 0) return false;
  for (ComponentMask reads = slot.reads; reads != 0; reads &= reads - 1) {
    if (thread.ready[register_of(reads)] != 0) return false;
  }
  // Results of one register arrive in order.
  const auto in_order = [&](ComponentMask writes, Countdown latency) {
    for (; writes != 0; writes &= writes - 1) {
      if (thread.ready[register_of(writes)] > latency) return false;
    }
    return true;
  };
  return in_order(slot.vector_writes, vector_latency_) && in_order(slot.scalar_writes, scalar_latency_);
}

Issued IssueLogic::issue(int number) {
  Thread& thread = threads_[static_cast<std::size_t>(number)];
  const IssueSlot& slot = (*slots_)[thread.slot];
  const auto record = [&](ComponentMask writes, Countdown latency) {
    for (; writes != 0; writes &= writes - 1) thread.ready[register_of(writes)] = latency;
    thread.result = std::max(thread.result, latency);
  };
  if (slot.has_vector) record(slot.vector_writes, vector_latency_);
  if (slot.has_scalar) {
    record(slot.scalar_writes, scalar_latency_);
    scalar_free_ = scalar_interval_;
  }
  const Issued issued{number, thread.slot, thread.slot + 1u == slots_->size(), thread.result};
  ++thread.slot;
  if (issued.is_last) {
    // The next vertex has its own registers: nothing of this one matters to it.
    thread = {};
    thread.slot = static_cast<std::uint16_t>(slots_->size());
    thread.reload = static_cast<Countdown>(reload_cycles_ + 1);  // this cycle, and these
    --held_;
  }
  return issued;
}

std::optional<Issued> IssueLogic::issue() {
  std::optional<Issued> issued;
  const int threads = static_cast<int>(threads_.size());
  for (int i = 0; i < threads && !issued; ++i) {
    const int number = turn_ + i < threads ? turn_ + i : turn_ + i - threads;
    if (!can_issue(threads_[static_cast<std::size_t>(number)])) continue;
    issued = issue(number);
  }
  if (issued) turn_ = issued->thread + 1 == threads ? 0 : issued->thread + 1;
  pass_cycle();
  return issued;
}

void IssueLogic::pass_cycle() {
  const auto count_down = [](Countdown& count) { count = static_cast<Countdown>(count - (count != 0)); };
  for (Thread& thread : threads_) {
    count_down(thread.reload);
    count_down(thread.result);
    for (Countdown& ready : thread.ready) count_down(ready);
  }
  count_down(scalar_free_);
}

Cycle IssueLogic::next_free() const {
  Cycle next = kNever;
  for (const Thread& thread : threads_) {
    if (thread.slot == slots_->size()) next = std::min(next, Cycle{thread.reload});
  }
  return next;
}

int IssueLogic::take() {
  for (std::size_t number = 0; number < threads_.size(); ++number) {
    Thread& thread = threads_[number];
    if (thread.slot != slots_->size() || thread.reload != 0) continue;
    thread.slot = 0;
    ++held_;
    return static_cast<int>(number);
  }
  throw ModelError("a vertex unit was given a vertex that no thread can take");
}

bool IssueLogic::is_at_rest() const {
  return held_ == 0 && scalar_free_ == 0 &&
         std::all_of(threads_.begin(), threads_.end(), [](const Thread& t) { return t.reload == 0; });
}

bool IssueLogic::operator==(const IssueLogic& other) const {
  return turn_ == other.turn_ && scalar_free_ == other.scalar_free_ && threads_ == other.threads_;
}

std::size_t IssueLogic::hash() const {
  std::size_t hash = static_cast<std::size_t>(turn_) << 8 | scalar_free_;
  const auto add = [&](std::size_t value) { hash = (std::rotl(hash, 23) ^ value) * 0x9e3779b97f4a7c15u; };
  for (const Thread& thread : threads_) {
    add(std::size_t{thread.slot} << 16 | std::size_t{thread.reload} << 8 | thread.result);
    add(std::hash<std::string_view>{}(
        {reinterpret_cast<const char*>(thread.ready.data()), thread.ready.size()}));
  }
  return hash;
}

}  // namespace splatscope::sim
