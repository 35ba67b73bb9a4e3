#pragma once

#include <cstdint>

#include "sim/kernel/cycle.h"

namespace splatscope::sim {

class Unit;
struct Result;
struct SimulatedMachine;

// Is told what happens in a machine while it runs, and changes nothing of it. Cycles are of the core clock,
// also for units on the bus.
class Observer {
 public:
  virtual ~Observer() = default;
  // Before the first cycle. The machine outlives the calls below.
  virtual void begin(const SimulatedMachine& machine) = 0;
  // `unit` booked the cycles from `from` to before `until` under `book` (see Step). In order for each unit,
  // without a gap, up to the end.
  virtual void booked(const Unit& unit, std::uint32_t book, Cycle from, Cycle until) = 0;
  // In the first cycle that the core visits at or after the one that the last call returned (at first 0);
  // kNever: not again.
  virtual Cycle sample(Cycle now) = 0;
  // After the last of these. Then the machine goes.
  virtual void end(const Result& result) = 0;
};

}  // namespace splatscope::sim
