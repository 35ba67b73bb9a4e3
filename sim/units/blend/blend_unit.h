#pragma once

#include "model/machine/machine.h"
#include "sim/units/cache/cache_pipe.h"
#include "sim/units/draw_unit.h"
#include "sim/units/frame_lines.h"

namespace splatscope::sim {

// Blends quads into the frame buffer through a write-back cache. Draws that do not blend write without
// reading.
class BlendUnit final : public DrawUnit {
 public:
  BlendUnit(std::string name, Completion& completion, const Machine::Blend& spec, const FrameLines& lines,
            int quads_per_clock);
  void connect(Channel<std::uint32_t>& in, MemoryPort& port, std::uint32_t address);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics() const override;
  std::string state() const override;

  // From the command processor: dirty lines go to memory; the cache is emptied.
  void begin_flush() { flushing_ = true; }
  void clear() { cache_.invalidate(); }

 private:
  std::uint64_t start(const DrawJob& job) override;
  bool leave(Cycle now);
  bool enter(Cycle now);
  Step flush(Cycle now);

  FrameLines lines_;
  int quads_per_clock_;
  Channel<std::uint32_t>* in_ = nullptr;
  CachePipe cache_;
  bool flushing_ = false;
  const Unit* in_the_way_ = nullptr;
  std::uint64_t quads_ = 0;
};

}  // namespace splatscope::sim
