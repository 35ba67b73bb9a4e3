#pragma once

#include <memory>
#include <span>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "model/work/work.h"
#include "sim/fidelity/what_if.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// The cycles of a trace from the counts of its work: no event is simulated. Each draw is cut into stretches
// as long as what the queues between the units hold; the busiest unit of a stretch sets its time, and a draw
// has the pipeline's latency on top. Misses of the frame and texture caches are counted on the tags for the
// sampled triangles of each draw (DrawWork::is_sampled). Rows of DRAM, contention, waits between units, and
// the rest of a line of memory of which one vertex is fetched (where vertices are not in the order of their
// indices), and what the caches write back where they are flushed do not count; nor does what a vertex that
// is shaded again finds in the vertex cache.
//
// Of the result, `event_hash` is 0, `statistics` is empty, and a unit that is not busy is starved. Throws
// like simulate().
Result estimate_throughput(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                           const WhatIf& what_if = {});

// The same draw by draw, as the function gets done with them: the work of a draw is looked at once.
class ThroughputEstimate {
 public:
  // Trace and machine outlive it.
  ThroughputEstimate(const Trace& trace, const Machine& machine, const WhatIf& what_if);
  ~ThroughputEstimate();

  void add(const DrawWork& work);  // of the next draw. Throws like simulate().
  Result result();                 // behind the last draw

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace splatscope::sim
