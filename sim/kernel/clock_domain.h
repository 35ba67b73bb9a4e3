#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/kernel/cycle.h"

namespace splatscope::sim {

class Observer;
class Unit;

enum class Scheduler : std::uint8_t {
  skip_ahead,  // only the units that can act, only in the cycles in which one can
  referee      // every unit in every cycle, every instruction issued: the dullest reading of the same units
};

// Each cycle of a unit has one cause.
struct Books {
  static constexpr std::uint32_t kMostUnits = 64;
  std::array<Cycle, 3 + kMostUnits> cycles{};  // by Step::book
  std::uint32_t book = 2;                      // idle before the first call
  Cycle since = 0;

  void enter(std::uint32_t next, Cycle at) {
    cycles[book] += at - since;
    book = next;
    since = at;
  }
};

// The units of one clock, called in the order in which they were added. Plain C++: run() needs no SystemC
// kernel. A unit sleeps until the cycle that its advance() returned or until a channel wakes it; a cycle in
// which no unit can act is not visited. Wakes of the next 64 cycles stand on a wheel (one bit a unit), later
// ones in a list.
class ClockDomain {
 public:
  // Books count cycles of a clock of period `reference`, so that the books of all domains add up to the same.
  ClockDomain(std::string name, Femtoseconds period, Femtoseconds reference, Scheduler scheduler);

  // First called in cycle 0. `number` is its number in the whole machine. At most 64 units.
  void add(Unit& unit, std::uint32_t number);

  // Runs every cycle up to and including `last`, or until nothing is left to do; a push across the boundary
  // to another domain may lower `last` on the way. UserError where the next cycle is later than kMostTime.
  void run(Cycle last);
  void lower_limit(Femtoseconds time);  // run() stops after the last cycle at or before `time`

  // `at` is later than the last visited cycle; before the first visit, any cycle.
  void wake(int place, Cycle at) {
    if (at - now_ <= kWheel) {
      wheel_[at % kWheel] |= std::uint64_t{1} << place;
      occupied_ |= std::uint64_t{1} << (at % kWheel);
    } else if (at < later_[static_cast<std::size_t>(place)]) {
      later_[static_cast<std::size_t>(place)] = at;
      if (at < earliest_later_) earliest_later_ = at;
    }
  }

  // The earliest cycle at which a unit can act; kNever: none can unless another domain wakes it.
  Cycle next() const {
    if (occupied_ == 0) return earliest_later_;
    const Cycle first = now_ + 1;
    const auto ahead =
        static_cast<Cycle>(std::countr_zero(std::rotr(occupied_, static_cast<int>(first % kWheel))));
    return first + ahead < earliest_later_ ? first + ahead : earliest_later_;
  }
  // The next cycle that run() visits: with the referee every one while any domain of the run has something to
  // do.
  Cycle next_visited() const;
  Femtoseconds next_time() const {
    const Cycle next = next_visited();
    return next == kNever ? kNever : time(next);
  }

  const std::string& name() const { return name_; }
  Scheduler scheduler() const { return scheduler_; }
  Femtoseconds time(Cycle cycle) const { return cycle * period_; }
  Cycle first_after(Femtoseconds time) const { return time / period_ + 1; }
  Cycle reference_cycle(Cycle cycle) const {
    return period_ == reference_ ? cycle : cycle * period_ / reference_;
  }
  // The first cycle whose reference cycle is `reference` or later; kNever where no run gets there.
  Cycle first_at(Cycle reference) const {
    return reference > kMostTime / reference_ ? kNever : cycles_of(reference * reference_, period_);
  }

  // Tells `observer`, which outlives the run, what its units book, and asks it to sample.
  void observe(Observer& observer);
  // The last of it: what the units have booked since their last change, up to reference cycle `end`.
  void finish_observing(Cycle end);
  // Reference cycles before `at` that unit `place` was busy so far.
  Cycle busy(std::size_t place, Cycle at) const;

  void set_peers(std::vector<const ClockDomain*> peers) { peers_ = std::move(peers); }
  const std::vector<Unit*>& units() const { return units_; }
  // The books of unit `place`, closed at reference cycle `end`. ModelError where they do not add up to it.
  Books closed_books(std::size_t place, Cycle end) const;

 private:
  static constexpr Cycle kWheel = 64;

  struct Watch {
    Observer* observer;
    Cycle next_sample;  // of this domain; kNever: none
  };

  void visit(Cycle now);
  void tell(std::size_t place, Cycle until) const;
  void sample();
  void call(std::uint64_t due);

  std::string name_;
  Femtoseconds period_;
  Femtoseconds reference_;
  Scheduler scheduler_;
  Cycle now_ = kNever;  // the last cycle visited; before the first, -1
  Cycle limit_ = 0;
  std::uint64_t occupied_ = 0;  // bit s: wheel_[s] is not empty
  std::array<std::uint64_t, kWheel> wheel_{};
  Cycle earliest_later_ = kNever;
  std::vector<Cycle> later_;
  std::vector<Unit*> units_;
  std::vector<Books> books_;
  std::vector<const ClockDomain*> peers_;
  std::vector<Watch> watches_;
  Cycle next_sample_ = kNever;  // the earliest of the watches
};

}  // namespace splatscope::sim
