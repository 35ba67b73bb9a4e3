#pragma once

#include <cstdint>
#include <span>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "model/work/work.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// The cycles of a trace from systematic samples of its draws, simulated as `cycle` does (SMARTS: Wunderlich
// et al. 2003, with the functional warming of caches; here the vertex pipeline stays full between samples).
//
// Draws of one frame and state form a population of units of two stretches (`stretches.h`); every n-th unit
// is a sample, the first one of each draw at random from `seed`. Of each draw its start, its samples and its
// end run as one draw: what lies between them passes through the tags of the caches alone, and the two
// stretches before a sample (more where the machine's queues hold more) warm what else has a memory: queues,
// rows of DRAM, vertices in flight. The start is six times as long: queues fill late where what is before
// them is about as fast as what is behind. What was left out then takes what the samples say, by the ratio of
// their cycles to what `Stretches` expect of them. Short draws, and a population of fewer than `kFewest`
// units for each sample, are simulated whole, as are clears and what the host does. Samples at equal
// distances can fall in step with something periodic in a draw: of one draw at 24,200 to 30,200 triangles,
// 25,900 to 26,100 scattered four times as far as the others, and up to two intervals in five missed. Where a
// vertex takes no more clocks than a few vertex threads hold up each other by (programs of 3 slots;
// `vertex.reload_cycles` as many), the cuts change the rhythm that they fall into: made-up draws of these
// were up to 3.3 % off, on one side, outside of every interval; so were the paper's programs by 1.4 % with
// three threads, where long queues set the cuts elsewhere. One draw of growing quads, whose bottleneck moved
// from AGP to a slow memory, was 1.2 % too fast beside 0.9 %. A sample at a random place of each part misses
// no more than is promised there, but scatters three times as far everywhere else (2.4 % in place of 0.7).
//
// Of the result, `cycles_plus_minus` is half the 95 % confidence interval, and so is each frame's: from the
// scatter of the samples, and kCutBias of what was estimated, for what they have in common. `event_hash` is 0
// and `statistics` is empty. The books are estimated by the same samples. Throws like simulate().
Result estimate_sampled(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                        std::uint64_t seed = 1);

// The same while the work is still being computed, as simulate_beside() does. `progress` is told the fraction
// of the draws that are done as the next one begins.
Result estimate_sampled_beside(const Trace& trace, const PartSource& next_part, const Machine& machine,
                               std::uint64_t seed = 1, const std::function<void(double)>& progress = {});

}  // namespace splatscope::sim
