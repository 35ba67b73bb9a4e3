#pragma once

#include <bit>
#include <string>
#include <vector>

#include "sim/kernel/unit.h"

namespace splatscope::sim {

// What can be seen of a channel from outside: for the dump of a deadlock, and for observers.
class ChannelState {
 public:
  virtual ~ChannelState() = default;
  virtual const std::string& name() const = 0;
  virtual const Unit& producer() const = 0;
  virtual const Unit& consumer() const = 0;
  virtual std::uint64_t items() const = 0;   // pushed and not popped yet
  virtual std::uint64_t popped() const = 0;  // so far
  virtual std::string describe() const = 0;
};

// A bounded queue from one unit to another. Its slots carry a cycle: *visible at* while full, *free at* while
// empty. A push at t is seen at t + latency (at least 1), a pop at t frees its slot at t + 1; so what a unit
// sees in a cycle does not depend on which units were called before it in that cycle. Where the two units are
// of different domains, a push is seen at the consumer's first edge after t, plus latency - 1 of its cycles,
// and a slot is free at the producer's first edge after the pop.
template <class T>
class Channel final : public ChannelState {
 public:
  Channel(std::string name, Unit& producer, Unit& consumer, int capacity, int latency = 1)
      : name_(std::move(name)),
        producer_(producer),
        consumer_(consumer),
        crossing_(!producer.shares_domain(consumer)),
        capacity_(static_cast<std::uint32_t>(capacity)),
        latency_(static_cast<Cycle>(latency)),
        mask_(std::bit_ceil(capacity_) - 1),
        slots_(mask_ + 1) {}
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  Unit& producer() const override { return producer_; }
  Unit& consumer() const override { return consumer_; }
  bool empty() const { return head_ == tail_; }

  // Producer's side. The slot of the next push is the one that item tail_ - capacity_ had.
  bool can_push(Cycle now) const { return next_free() <= now; }
  // When a push is possible; kNever: not before the consumer pops (which wakes the producer).
  Cycle next_free() const {
    if (tail_ - head_ >= capacity_) return kNever;
    return tail_ < capacity_ ? 0 : slots_[(tail_ - capacity_) & mask_].at;
  }
  void push(Cycle now, const T& value) {
    Slot& slot = slots_[tail_ & mask_];
    slot.value = value;
    slot.at = crossing_ ? across(now, producer_, consumer_) + latency_ - 1 : now + latency_;
    if (head_ == tail_++) {
      visible_ = slot.at;
      wake(consumer_, producer_, slot.at);
    }
  }

  // Consumer's side.
  bool can_pop(Cycle now) const { return next_visible() <= now; }
  // When the front item is visible; kNever: the channel is empty (a push wakes the consumer).
  Cycle next_visible() const { return visible_; }
  const T& front() const { return slots_[head_ & mask_].value; }
  T pop(Cycle now) {
    Slot& slot = slots_[head_ & mask_];
    slot.at = crossing_ ? across(now, consumer_, producer_) : now + 1;
    if (tail_ - head_++ >= capacity_) wake(producer_, consumer_, slot.at);
    visible_ = empty() ? kNever : slots_[head_ & mask_].at;
    return slot.value;
  }

  const std::string& name() const override { return name_; }
  std::uint64_t items() const override { return tail_ - head_; }
  std::uint64_t popped() const override { return head_; }
  std::string describe() const override {
    return name_ + " (" + producer_.name() + " to " + consumer_.name() + "): " + std::to_string(items()) +
           " of " + std::to_string(capacity_);
  }

 private:
  struct Slot {
    T value{};
    Cycle at = 0;
  };

  static Cycle across(Cycle now, const Unit& from, const Unit& to) {
    return to.domain().first_after(from.domain().time(now));
  }
  void wake(Unit& sleeper, const Unit& waker, Cycle at) {
    sleeper.wake(at);
    if (crossing_) waker.domain().lower_limit(sleeper.domain().time(at));
  }

  std::string name_;
  Unit& producer_;
  Unit& consumer_;
  bool crossing_;
  std::uint32_t capacity_;
  Cycle latency_;
  std::uint64_t mask_;
  std::uint64_t head_ = 0;  // items popped so far
  std::uint64_t tail_ = 0;  // items pushed so far
  Cycle visible_ = kNever;  // of the front item, which is asked for more often than there is another
  std::vector<Slot> slots_;
};

}  // namespace splatscope::sim
