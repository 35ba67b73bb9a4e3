#pragma once

#include "model/machine/machine.h"
#include "sim/units/cache/cache_pipe.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// Looks the texel blocks of quads up in the texture cache; quads wait for their misses in a FIFO that hides
// the latency of memory. Nearest sampling: one texel a pixel. Quads of draws without a texture pass through.
class TextureUnit final : public DrawUnit {
 public:
  TextureUnit(std::string name, Completion& completion, const Machine::Texture& spec, int quads_per_clock);
  void connect(Channel<std::uint32_t>& in, Channel<std::uint32_t>& out, MemoryPort& port);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics() const override;
  std::string state() const override;

 private:
  std::uint64_t start(const DrawJob& job) override;
  bool leave(Cycle now);
  bool look_up(Cycle now, int& lookups);

  Machine::Texture spec_;
  int quads_per_clock_;
  std::uint32_t line_shift_;  // blocks a line
  Channel<std::uint32_t>* in_ = nullptr;
  Channel<std::uint32_t>* out_ = nullptr;
  MemoryPort* port_ = nullptr;
  CachePipe cache_;
  bool textured_ = false;
  std::size_t next_block_ = 0;     // of the draw
  std::uint32_t blocks_done_ = 0;  // of the quad that is being looked up
  const Unit* in_the_way_ = nullptr;
  std::uint64_t quads_ = 0;
};

}  // namespace splatscope::sim
