#include "sim/units/pixel/pixel_unit.h"

namespace splatscope::sim {

PixelUnit::PixelUnit(std::string name, Completion& completion, int quads_per_clock)
    : DrawUnit(std::move(name), completion), quads_per_clock_(quads_per_clock) {}

void PixelUnit::connect(const QuadSources& in, Items& out) {
  sources_ = in;
  out_ = &out;
}

void PixelUnit::start(const DrawJob& job) {
  in_ = sources_.of(job);
}

Step PixelUnit::advance(Cycle now) {
  if (free_from_ > now) return busy(free_from_);
  if (!in_) return idle();  // before the first draw
  if (!in_->can_pop(now)) return nothing_to_take(in_->next_visible());
  if (!out_->can_push(now)) return blocked(out_->consumer(), out_->next_free());
  free_from_ = now + job().pixel_clocks;
  for (int i = 0; i < quads_per_clock_ && in_->can_pop(now) && out_->can_push(now); ++i) {
    const std::uint32_t quad = in_->pop(now);
    out_->push(now, quad);
    event(now, quad);
    ++quads_;
    item_done(free_from_ - 1);
  }
  return busy(free_from_);
}

std::vector<Statistic> PixelUnit::statistics(Cycle) const {
  return {{"quads", "quads", "that ran the pixel program", quads_}};
}

}  // namespace splatscope::sim
