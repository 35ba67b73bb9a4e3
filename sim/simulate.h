#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "model/work/work.h"
#include "sim/kernel/clock_domain.h"
#include "sim/kernel/observer.h"
#include "sim/left_out.h"
#include "sim/machine.h"

// When it happens: the cycle-level timing of a trace on a machine.
namespace splatscope::sim {

// Where the cycles of a unit went; they add up to the run's. All in core cycles, also for the units on the
// bus clock.
struct UnitBooks {
  std::string name;
  Cycle busy = 0;
  Cycle starved = 0;  // waiting for the unit before it
  Cycle blocked = 0;  // waiting for another unit to take or to deliver something
  Cycle idle = 0;     // nothing to do
  std::vector<std::pair<std::string, Cycle>> blocked_by;  // who, and how long; adds up to `blocked`
};

struct UnitStatistic {
  std::string unit_name;  // "texture"
  std::string name;       // "misses"
  std::string unit;       // "lines"
  std::string what;
  std::uint64_t value = 0;
};

// A channel between two units, by their names, and the items that went through it.
struct ChannelUse {
  std::string from, to;
  std::uint64_t items = 0;
};

struct Result {
  Cycle cycles = 0;  // of the core clock, from the first command to the last frame in memory
  double seconds = 0;
  double cycles_plus_minus = 0;  // half a 95 % confidence interval; 0: nothing was sampled
  std::uint64_t event_hash = 0;  // of every retirement and every memory decision with its cycle
  std::vector<UnitBooks> units;
  std::vector<UnitStatistic> statistics;
  std::vector<UnitLeftOut> units_left_out;
  std::vector<ChannelUse> channels;      // where events are simulated
  std::vector<Cycle> command_ends;       // core cycle at which each command of the trace was done
  std::vector<Cycle> frame_cycles;       // of each frame (`frame_ends`); they add up to `cycles`
  std::vector<double> frame_plus_minus;  // as `cycles_plus_minus`, of each frame alone; empty: simulated

  double seconds_of(Cycle some) const { return seconds * share(some); }
  double share(Cycle some) const {
    return cycles == 0 ? 0 : static_cast<double>(some) / static_cast<double>(cycles);
  }
  struct Bottleneck {
    std::string unit;
    Cycle busy = 0;
    std::size_t vertex_units = 0;  // not 0: `busy` is that of the least busy of so many
  };
  // The unit that was busy for the largest share of the run. Vertex units, of which the first that is free
  // takes a vertex, count together, as busy as the least busy of them, under the name of the busiest. A
  // memory channel is busy also while it waits for its DRAM, and AGP while as many requests are on the way as
  // may be: at 90 % their data buses may be half empty (`data_clocks`).
  Bottleneck bottleneck() const;
  // 0 where they take no time.
  double frames_per_second() const { return rate(static_cast<double>(frame_cycles.size()), seconds); }
  double frames_per_second(Cycle one_frame) const { return rate(1, seconds_of(one_frame)); }

 private:
  static double rate(double count, double seconds) { return seconds > 0 ? count / seconds : 0; }
};

// The books of a unit of `machine` with the names of the units in its way.
UnitBooks named_books(const SimulatedMachine& machine, const Unit& unit, const Books& books);
std::vector<UnitStatistic> named_statistics(const Unit& unit);

// Core cycles of each frame, from the end of the one before it to the end of its last command, of a result
// whose `cycles` and `command_ends` are known.
std::vector<Cycle> cycles_of_frames(const Trace& trace, const Result& result);

// Simulates `trace`, whose draws gave the stages `work` to do (one record for each Draw, in order), on
// `machine`. `progress` is told the fraction done, from 0 to 1. May be called many times in a process, and
// from several threads (which then take turns on the SystemC kernel). `observers` change nothing. Throws
// UserError where a program of the trace does not load, ModelError for a bug of the simulation: work that
// does not fit the trace, or a deadlock, with what every unit and channel holds.
Result simulate(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                Scheduler scheduler = Scheduler::skip_ahead, const std::function<void(double)>& progress = {},
                std::span<Observer* const> observers = {}, UnitChoice choice = UnitChoice::needed);

// The same while the work is still being computed: `next_part` is asked for it as it is needed, may wait for
// it, and may cut each draw's where it likes between triangles (as render_in_parts() does). What it gives is
// needed until it is asked again.
using PartSource = std::function<const DrawWork&()>;
Result simulate_beside(const Trace& trace, const PartSource& next_part, const Machine& machine,
                       Scheduler scheduler = Scheduler::skip_ahead,
                       const std::function<void(double)>& progress = {},
                       std::span<Observer* const> observers = {});

}  // namespace splatscope::sim
