#pragma once

#include "model/machine/machine.h"
#include "sim/units/cache/cached_unit.h"

namespace splatscope::sim {

// Blends quads into the frame buffer through a write-back cache. Draws that do not blend write without
// reading.
class BlendUnit final : public FrameUnit {
 public:
  BlendUnit(std::string name, Completion& completion, const Machine::Blend& spec, const FrameLines& lines,
            int quads_per_clock);
  void connect(Channel<std::uint32_t>& in, MemoryPort& port, std::uint32_t address);

  std::vector<Statistic> statistics() const override;

  // From the command processor: the cache is emptied.
  void clear() { cache_.invalidate(); }

 private:
  std::uint64_t start(const DrawJob& job) override;
  bool leave(Cycle now) override;
  bool enter(Cycle now) override;
  void pass(const Cut& cut) override;

  std::uint64_t quads_ = 0;
};

}  // namespace splatscope::sim
