#pragma once

#include "model/machine/machine.h"
#include "sim/units/cache/cached_unit.h"

namespace splatscope::sim {

// Blends quads into the frame buffer, or an off-screen surface, through a write-back cache that holds lines
// of all of them. Draws that do not blend write without reading.
class BlendUnit final : public FrameUnit {
 public:
  BlendUnit(std::string name, Completion& completion, const Machine::Blend& spec, const FrameLines& lines,
            int quads_per_clock);
  void connect(Items& in, MemoryPort& port, std::uint32_t address);

  std::uint64_t items(const DrawJob& job) const override { return job.counts.colored_quads; }
  bool takes_part(const DrawJob& job) const override { return job.draw->state.color_write; }
  std::vector<Statistic> statistics(Cycle) const override;

  // From the command processor: the cache drops the frame's lines.
  void clear() { cache_.invalidate(lines_.lines()); }

 private:
  bool leave(Cycle now) override;
  bool enter(Cycle now) override;
  void pass(const Cut& cut) override;
  std::uint32_t line_of(const QuadWork& quad) const {
    return job().draw->target * lines_.lines() + lines_.line_of(quad);
  }

  std::uint64_t quads_ = 0;
};

}  // namespace splatscope::sim
