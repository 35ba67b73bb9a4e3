#pragma once

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// Walks the 8x8-pixel tiles of a triangle and sends out the 2x2 quads with coverage. The tile walk runs
// beside the quads: a triangle takes as long as the longer of the two, at least a clock.
class Rasteriser final : public DrawUnit {
 public:
  Rasteriser(std::string name, Completion& completion, const Machine::Raster& spec, int quads_per_clock);
  // `out`: the numbers of the quads; nullptr: no draw tests depth or writes colour, and quads end here.
  // `all_quads`: the depth test takes all; else only coloured quads go out.
  void connect(Channel<std::uint32_t>& in, Channel<std::uint32_t>* out, bool all_quads);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics() const override;
  std::string state() const override;

 private:
  std::uint64_t start(const DrawJob& job) override;
  int send(Cycle now);

  Machine::Raster spec_;
  int quads_per_clock_;
  Channel<std::uint32_t>* in_ = nullptr;
  Channel<std::uint32_t>* out_ = nullptr;
  bool all_quads_ = true;
  bool walking_ = false;
  std::uint32_t triangle_ = 0;
  std::uint32_t next_quad_ = 0;                    // of the draw
  std::uint32_t quads_left_ = 0, tiles_left_ = 0;  // of the triangle
  std::uint64_t quads_ = 0, tiles_ = 0, empty_ = 0;
};

}  // namespace splatscope::sim
