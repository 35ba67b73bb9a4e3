#include "sim/units/blend/blend_unit.h"

namespace splatscope::sim {

BlendUnit::BlendUnit(std::string name, Completion& completion, const Machine::Blend& spec,
                     const FrameLines& lines, int quads_per_clock)
    : FrameUnit(std::move(name), completion,
                {spec.cache_lines, spec.cache_ways, lines.line_bytes(), lines.line_bytes(), spec.pending},
                lines, quads_per_clock) {}

void BlendUnit::connect(Items& in, MemoryPort& port, std::uint32_t address) {
  in_ = &in;
  cache_.connect(port, address);
}

void BlendUnit::pass(const Cut& cut) {
  for (const QuadWork& quad : cut.quads) {
    if (is_colored(job(), quad)) cache_.pass(line_of(quad), true);
  }
}

bool BlendUnit::leave(Cycle now) {
  if (cache_.empty() || !cache_.is_ready(now)) return false;
  event(now, cache_.leave());
  ++quads_;
  item_done(now);
  return true;
}

bool BlendUnit::enter(Cycle now) {
  if (!cache_.has_room() || !in_->can_pop(now)) return false;
  pass_cuts(in_->front());
  const QuadWork& quad = job().quads[in_->front()];
  in_the_way_ = cache_.touch(now, line_of(quad), job().draw->state.blend, true);
  if (in_the_way_) return false;
  cache_.enter(in_->pop(now));
  return true;
}

std::vector<Statistic> BlendUnit::statistics(Cycle) const {
  return {{"quads", "quads", "written", quads_},
          {"misses", "lines", "that the colour cache did not hold", cache_.misses()},
          {"write_backs", "lines", "written to memory", cache_.write_backs()}};
}

}  // namespace splatscope::sim
