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
  std::vector<Statistic> statistics(Cycle) const override;

 private:
  std::uint64_t start(const DrawJob& job) override;

  Machine::Setup spec_;
  Items* in_ = nullptr;
  Items* out_ = nullptr;
  Cycle free_from_ = 0;
  std::uint64_t triangles_ = 0;
};

}  // namespace splatscope::sim
