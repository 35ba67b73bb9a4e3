#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "model/work/work.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// The cycles of a trace from samples of its draws, simulated as `cycle` does, at a share of what that takes
// (SMARTS: Wunderlich et al. 2003, with the functional warming of caches; here the vertex pipeline stays full
// between samples).
//
// The stretches (`stretches.h`) of a frame's draws of one state are a population, one draw's behind the
// other's. Of every 24 in a row one is a sample, at a random place from `seed`; of a small population 18, of
// as many equal parts. Of each draw its start, its samples and its end run as one draw: what lies between
// them passes through the tags of the caches alone, and one to two stretches before a sample (more where the
// machine's queues hold more) warm what else has a memory: queues, rows of DRAM, vertices in flight. The
// start is six times what fills the queues: they fill late where what is before them is about as fast as what
// is behind. What was left out then takes what the samples say, by the ratio of their cycles to what
// `Stretches` expect of them. Short draws and small populations are simulated whole, as are clears and what
// the host does.
//
// So few are enough where the throughput of one stage is what the stretches take. A second run with more
// samples is for frames whose interval is wider than kPrecision, and for populations whose time no stage
// explains, or of which two stages are about as slow: of these the samples may be alike by chance. Where half
// of a population would run, it is simulated whole.
//
// Places at equal distances, or by a sequence of low discrepancy, scatter less on most draws, and fell in
// step with rows of tiles or surfels on others, far outside of their intervals. Meshes by programs of few
// slots come out up to 1.7 % too fast, as the cuts change the rhythm that few vertex threads fall into.
//
// Of the result, `cycles_plus_minus` is half the 95 % confidence interval, and so is each frame's: from the
// scatter of the samples, and kCutBias of what was estimated, for what they have in common. `event_hash` is 0
// and `statistics` is empty. The books are estimated by the same samples.

// Half the interval that a second run is to have at most, of a frame's cycles.
inline constexpr double kPrecision = 0.02;

struct Sampling {
  std::uint64_t seed = 1;
  std::vector<double> density = {};  // by frame, samples for one of a first run; empty: this is one
};

struct SampledRun {
  Result result;
  std::vector<double> density;  // that a second run is to have; empty: it needs none, or was one
};

// A run, and another one where that was not enough. Throws like simulate().
Result estimate_sampled(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                        std::uint64_t seed = 1);

// One run, while the work is still being computed, as simulate_beside() does. `progress` is told the fraction
// of the draws that are done as the next one begins.
SampledRun estimate_sampled_beside(const Trace& trace, const PartSource& next_part, const Machine& machine,
                                   const Sampling& sampling = {},
                                   const std::function<void(double)>& progress = {});

}  // namespace splatscope::sim
