#pragma once

#include "studies/run.h"

namespace splatscope::studies {

// What a frame costs the host, the least of some runs, and its time.
struct FrameCost {
  double seconds = 0;                 // function and timing
  double megabytes = 0;               // of the process in memory at most; 0: unknown
  std::optional<sim::Result> timing;  // absent: functional
};

// Runs the frame of `trace` `runs` times, at least once.
FrameCost cost_of(const Trace& trace, const Machine& machine, Fidelity fidelity, int runs);

}  // namespace splatscope::studies
