#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

#include "sim/kernel/clock_domain.h"
#include "sim/kernel/cycle.h"

namespace splatscope::sim {

// A statistic, declared once beside its unit.
struct Statistic {
  std::string_view name;  // "row_hits"
  std::string_view unit;  // "requests"
  std::string_view what;  // one line
  std::uint64_t value = 0;
};

// What a unit did in a cycle, or why it did nothing, and until when that stays so unless a channel wakes it
// earlier. advance() returns one of busy(), starved(), idle() and blocked().
struct Step {
  Cycle next;  // to be called again no later than here (at or before now: next cycle; kNever: when woken)
  std::uint32_t book;  // kBusy, kStarved, kIdle, or kBlocked + number of the unit that is in the way

  static constexpr std::uint32_t kBusy = 0, kStarved = 1, kIdle = 2, kBlocked = 3;
};

// A hardware unit. Plain C++: what it does in a cycle depends on what was visible at its start, so the order
// in which the units of a domain are called never changes a result. advance() may be called in cycles where
// nothing can be done (the referee calls it in every cycle): then it changes nothing and books the same as
// the last call.
class Unit {
 public:
  explicit Unit(std::string name) : name_(std::move(name)) {}
  virtual ~Unit() = default;
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  virtual Step advance(Cycle now) = 0;
  // Up to cycle `now` of its domain, after the last one in which it acted; kNever: all that it began.
  virtual std::vector<Statistic> statistics(Cycle) const { return {}; }
  // What it holds and waits for, for the dump of a deadlock.
  virtual std::string state() const { return {}; }

  const std::string& name() const { return name_; }
  std::uint32_t number() const { return number_; }  // in the whole machine
  ClockDomain& domain() const { return *domain_; }  // once it is in one
  bool shares_domain(const Unit& other) const { return domain_ == other.domain_; }
  void wake(Cycle at) { domain_->wake(place_, at); }

  // Of every retirement and every decision so far, with its cycle and in its order.
  std::uint64_t event_hash() const { return event_hash_; }
  bool had_events() const { return event_hash_ != kNoEvents; }

 protected:
  static Step busy(Cycle next) { return {next, Step::kBusy}; }
  static Step starved(Cycle next) { return {next, Step::kStarved}; }
  static Step idle(Cycle next = kNever) { return {next, Step::kIdle}; }
  static Step blocked(const Unit& by, Cycle next) { return {next, Step::kBlocked + by.number()}; }

  void event(Cycle now, std::uint64_t what) {
    event_hash_ = (std::rotl(event_hash_, 23) ^ (now * 0x9e3779b97f4a7c15u) ^ what) * 0xd6e8feb86659fd93u;
  }

 private:
  friend class ClockDomain;  // gives it its place
  std::string name_;
  ClockDomain* domain_ = nullptr;
  int place_ = 0;
  std::uint32_t number_ = 0;
  static constexpr std::uint64_t kNoEvents = 0x243f6a8885a308d3u;
  std::uint64_t event_hash_ = kNoEvents;
};

}  // namespace splatscope::sim
