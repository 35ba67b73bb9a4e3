#pragma once

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"
#include "sim/units/quad_paths.h"

namespace splatscope::sim {

// Runs the pixel program: a fixed number of clocks a quad, in a pipeline as wide as the quads of a clock.
class PixelUnit final : public DrawUnit {
 public:
  PixelUnit(std::string name, Completion& completion, int quads_per_clock);
  void connect(const QuadSources& in, Items& out);

  Step advance(Cycle now) override;
  std::uint64_t items(const DrawJob& job) const override { return job.counts.colored_quads; }
  bool takes_part(const DrawJob& job) const override { return job.draw->state.color_write; }
  std::vector<Statistic> statistics(Cycle) const override;

 private:
  void start(const DrawJob& job) override;

  int quads_per_clock_;
  QuadSources sources_;
  Items* in_ = nullptr;  // of this draw
  Items* out_ = nullptr;
  Cycle free_from_ = 0;
  std::uint64_t quads_ = 0;
};

}  // namespace splatscope::sim
