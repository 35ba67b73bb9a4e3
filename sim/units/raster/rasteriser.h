#pragma once

#include <functional>
#include <utility>

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"
#include "sim/units/quad_paths.h"

namespace splatscope::sim {

// Walks the 8x8-pixel tiles of a triangle and sends out the 2x2 quads with coverage. The tile walk runs
// beside the quads: a triangle takes as long as the longer of the two, at least a clock.
class Rasteriser final : public DrawUnit {
 public:
  Rasteriser(std::string name, Completion& completion, const Machine::Raster& spec, int quads_per_clock);
  // The depth test takes all quads; past it only coloured ones go out.
  void connect(Items& in, const QuadTargets& out);

  // `on_quad` is told each quad in the cycle in which it is done; empty: nobody.
  void on_quad(std::function<void(Cycle, const QuadWork&)> on_quad) { on_quad_ = std::move(on_quad); }

  Step advance(Cycle now) override;
  std::uint64_t items(const DrawJob& job) const override { return job.counts.triangles_set_up; }
  std::vector<Statistic> statistics(Cycle) const override;
  std::string state() const override;

 private:
  void start(const DrawJob& job) override;
  int send(Cycle now);

  Machine::Raster spec_;
  int quads_per_clock_;
  Items* in_ = nullptr;
  QuadTargets targets_;
  Items* out_ = nullptr;  // of this draw; nullptr: quads end here
  bool all_quads_ = true;
  bool walking_ = false;
  std::uint32_t triangle_ = 0;
  std::uint32_t next_quad_ = 0;                    // of the draw
  std::uint32_t quads_left_ = 0, tiles_left_ = 0;  // of the triangle
  std::function<void(Cycle, const QuadWork&)> on_quad_;
  std::uint64_t quads_ = 0, tiles_ = 0, empty_ = 0;
};

}  // namespace splatscope::sim
