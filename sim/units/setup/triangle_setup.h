#pragma once

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"

namespace splatscope::sim {

// Sets up edges and gradients: a fixed number of clocks for each triangle, and for each piece of a clipped
// one.
class TriangleSetup final : public DrawUnit {
 public:
  TriangleSetup(std::string name, Completion& completion, const Machine::Setup& spec);
  void connect(Items& in, Items& out);

  Step advance(Cycle now) override;
  std::uint64_t items(const DrawJob& job) const override { return job.counts.triangles_set_up; }
  std::vector<Statistic> statistics(Cycle) const override;

 private:
  Machine::Setup spec_;
  Items* in_ = nullptr;
  Items* out_ = nullptr;
  Cycle free_from_ = 0;
  std::uint64_t triangles_ = 0;
};

}  // namespace splatscope::sim
