#pragma once

#include "model/machine/machine.h"
#include "sim/units/cache/cached_unit.h"
#include "sim/units/quad_paths.h"

namespace splatscope::sim {

// Looks the texel blocks of quads up in the texture cache; quads wait for their misses in a FIFO that hides
// the latency of memory. Nearest sampling: one texel a pixel.
class TextureUnit final : public CachedUnit {
 public:
  TextureUnit(std::string name, Completion& completion, const Machine::Texture& spec, int quads_per_clock);
  void connect(const QuadSources& in, Items& out, MemoryPort& port);

  Step advance(Cycle now) override;
  std::uint64_t items(const DrawJob& job) const override {
    return job.textured ? job.counts.colored_quads : 0;
  }
  bool takes_part(const DrawJob& job) const override { return job.textured; }
  std::vector<Statistic> statistics(Cycle) const override;

 private:
  void start(const DrawJob& job) override;
  bool leave(Cycle now);
  bool look_up(Cycle now, int& lookups);
  void pass(const Cut& cut) override;

  Machine::Texture spec_;
  std::uint32_t line_shift_;  // blocks a line
  Items* out_ = nullptr;
  MemoryPort* port_ = nullptr;
  QuadSources sources_;
  std::size_t next_block_ = 0;     // of the draw
  std::uint32_t blocks_done_ = 0;  // of the quad that is being looked up
  std::uint64_t quads_ = 0;
};

}  // namespace splatscope::sim
