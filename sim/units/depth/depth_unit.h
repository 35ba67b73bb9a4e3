#pragma once

#include <vector>

#include "model/machine/machine.h"
#include "sim/units/cache/cache_pipe.h"
#include "sim/units/draw_unit.h"
#include "sim/units/frame_lines.h"

namespace splatscope::sim {

// Tests quads against the depth buffer through a write-back cache, and sends on what passed and has colour.
// Draws that neither test nor write depth pass through. Lines that a fast clear marked are made in the cache,
// not read. Not modelled: compression and hierarchical rejection of depth.
class DepthUnit final : public DrawUnit {
 public:
  DepthUnit(std::string name, Completion& completion, const Machine::Depth& spec, const FrameLines& lines,
            int quads_per_clock);
  // `out`: quads to texture or pixel unit; nullptr: no draw writes colour.
  void connect(Channel<std::uint32_t>& in, Channel<std::uint32_t>* out, MemoryPort& port,
               std::uint32_t address);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics() const override;
  std::string state() const override;

  // From the command processor: dirty lines go to memory; all lines are cleared (`fast`: marked only).
  void begin_flush() { flushing_ = true; }
  void clear(bool fast);

 private:
  std::uint64_t start(const DrawJob& job) override;
  bool leave(Cycle now);
  bool enter(Cycle now);
  Step flush(Cycle now);

  FrameLines lines_;
  int quads_per_clock_;
  Channel<std::uint32_t>* in_ = nullptr;
  Channel<std::uint32_t>* out_ = nullptr;
  CachePipe cache_;
  std::vector<bool> cleared_;  // by line: not in memory yet
  bool flushing_ = false;
  const Unit* in_the_way_ = nullptr;
  std::uint64_t tested_ = 0, passed_ = 0;
};

}  // namespace splatscope::sim
