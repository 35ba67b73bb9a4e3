#include "studies/frame_cost.h"

#include <algorithm>

#include "studies/peak_memory.h"

namespace splatscope::studies {

FrameCost cost_of(const Trace& trace, const Machine& machine, Fidelity fidelity, int runs) {
  FrameCost cost;
  for (int i = 0; i < runs; ++i) {
    const bool is_measured = restart_peak_memory();
    FrameRun run = run_frame(trace, machine, fidelity);
    cost.seconds = i == 0 ? run.host_seconds : std::min(cost.seconds, run.host_seconds);
    cost.timing = std::move(run.timing);
    if (!is_measured) continue;
    const double megabytes = peak_megabytes();
    cost.megabytes = i == 0 ? megabytes : std::min(cost.megabytes, megabytes);
  }
  return cost;
}

}  // namespace splatscope::studies
