#include "sim/units/depth/depth_unit.h"

#include <algorithm>

namespace splatscope::sim {

DepthUnit::DepthUnit(std::string name, Completion& completion, const Machine::Depth& spec,
                     const FrameLines& lines, int quads_per_clock)
    : FrameUnit(std::move(name), completion,
                {spec.cache_lines, spec.cache_ways, lines.line_bytes(), lines.line_bytes(), spec.pending},
                lines, quads_per_clock),
      cleared_(lines.lines(), false) {}

void DepthUnit::connect(Items& in, const QuadTargets& out, MemoryPort& port, std::uint32_t address) {
  in_ = &in;
  targets_ = out;
  cache_.connect(port, address);
}

void DepthUnit::start(const DrawJob& job) {
  out_ = targets_.of(job);
}

void DepthUnit::pass(const Cut& cut) {
  const DrawState& state = job().draw->state;
  for (const QuadWork& quad : cut.quads) {
    const std::uint32_t line = lines_.line_of(quad);
    const bool writes = state.depth_write && quad.passed != 0;
    if (writes) cleared_[line] = false;
    cache_.pass(line, writes);
  }
}

void DepthUnit::clear(bool fast) {
  cache_.invalidate();
  std::fill(cleared_.begin(), cleared_.end(), fast);
}

bool DepthUnit::leave(Cycle now) {
  if (cache_.empty() || !cache_.is_ready(now)) return false;
  const QuadWork& quad = job().quads[cache_.oldest()];
  const bool colored = is_colored(job(), quad);
  if (colored && !out_->can_push(now)) return false;
  const std::uint32_t number = cache_.leave();
  if (colored) out_->push(now, number);
  passed_ += quad.passed != 0;
  event(now, number);
  item_done(now);
  return true;
}

bool DepthUnit::enter(Cycle now) {
  if (!cache_.has_room() || !in_->can_pop(now)) return false;
  const std::uint32_t number = in_->front();
  pass_cuts(number);
  const QuadWork& quad = job().quads[number];
  const std::uint32_t line = lines_.line_of(quad);
  const bool writes = job().draw->state.depth_write && quad.passed != 0;
  in_the_way_ = cache_.touch(now, line, !cleared_[line], writes);
  if (in_the_way_) return false;
  if (writes) cleared_[line] = false;
  ++tested_;
  cache_.enter(in_->pop(now));
  return true;
}

std::vector<Statistic> DepthUnit::statistics(Cycle) const {
  return {{"tested", "quads", "looked up in the depth cache", tested_},
          {"passed", "quads", "with a pixel that passed", passed_},
          {"misses", "lines", "that the depth cache did not hold", cache_.misses()},
          {"write_backs", "lines", "written to memory", cache_.write_backs()}};
}

}  // namespace splatscope::sim
