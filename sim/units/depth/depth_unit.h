#pragma once

#include <vector>

#include "model/machine/machine.h"
#include "sim/units/cache/cached_unit.h"
#include "sim/units/quad_paths.h"

namespace splatscope::sim {

// Tests quads against the depth buffer through a write-back cache, and sends on what passed and has colour.
// Lines that a fast clear marked are made in the cache, not read. Not modelled: compression and hierarchical
// rejection of depth.
class DepthUnit final : public FrameUnit {
 public:
  DepthUnit(std::string name, Completion& completion, const Machine::Depth& spec, const FrameLines& lines,
            int quads_per_clock);
  void connect(Items& in, const QuadTargets& out, MemoryPort& port, std::uint32_t address);

  std::uint64_t items(const DrawJob& job) const override {
    return uses_depth(*job.draw) ? job.counts.quads : 0;
  }
  bool takes_part(const DrawJob& job) const override { return uses_depth(*job.draw); }
  std::vector<Statistic> statistics(Cycle) const override;

  // From the command processor: all lines are cleared (`fast`: marked only).
  void clear(bool fast);

 private:
  void start(const DrawJob& job) override;
  bool leave(Cycle now) override;
  bool enter(Cycle now) override;
  void pass(const Cut& cut) override;

  QuadTargets targets_;
  std::vector<bool> cleared_;  // by line: not in memory yet
  std::uint64_t tested_ = 0, passed_ = 0;
};

}  // namespace splatscope::sim
