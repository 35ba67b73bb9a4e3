#include "sim/units/setup/triangle_setup.h"

namespace splatscope::sim {

TriangleSetup::TriangleSetup(std::string name, Completion& completion, const Machine::Setup& spec)
    : DrawUnit(std::move(name), completion), spec_(spec) {}

void TriangleSetup::connect(Items& in, Items& out) {
  in_ = &in;
  out_ = &out;
}

Step TriangleSetup::advance(Cycle now) {
  if (free_from_ > now) return busy(free_from_);
  if (!in_->can_pop(now)) return nothing_to_take(in_->next_visible());
  if (!out_->can_push(now)) return blocked(out_->consumer(), out_->next_free());
  const std::uint32_t triangle = in_->pop(now);
  out_->push(now, triangle);
  const Cycle pieces = job().triangles[triangle].pieces;
  free_from_ = now + pieces * static_cast<Cycle>(spec_.clocks_per_triangle);
  triangles_ += pieces;
  event(now, triangle);
  item_done(free_from_ - 1);
  return busy(free_from_);
}

std::vector<Statistic> TriangleSetup::statistics(Cycle) const {
  return {{"triangles", "triangles", "set up, each piece of a clipped one", triangles_}};
}

}  // namespace splatscope::sim
