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
  // From each clock domain: before anything is done in the first cycle that it visits at or after the one
  // that its last call returned (at first 0; kNever: not again). The domains visit their cycles in the order
  // of time, so in the first of these calls the machine is as it was at the start of that returned cycle.
  virtual Cycle sample(Cycle now) = 0;
  // After the last of these. Then the machine goes.
  virtual void end(const Result& result) = 0;
};

}  // namespace splatscope::sim
