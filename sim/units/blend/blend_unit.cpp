#include "sim/units/blend/blend_unit.h"

#include <algorithm>

namespace splatscope::sim {

BlendUnit::BlendUnit(std::string name, Completion& completion, const Machine::Blend& spec,
                     const FrameLines& lines, int quads_per_clock)
    : DrawUnit(std::move(name), completion),
      lines_(lines),
      quads_per_clock_(quads_per_clock),
      cache_({spec.cache_lines, spec.cache_ways, lines.line_bytes(), lines.line_bytes(), spec.pending}) {}

void BlendUnit::connect(Channel<std::uint32_t>& in, MemoryPort& port, std::uint32_t address) {
  in_ = &in;
  cache_.connect(port, address);
}

std::uint64_t BlendUnit::start(const DrawJob& job) {
  return job.colored_quads;
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
  const QuadWork& quad = job().work->quads[in_->front()];
  in_the_way_ = cache_.touch(now, lines_.line_of(quad), job().draw->state.blend, true);
  if (in_the_way_) return false;
  cache_.enter(in_->pop(now));
  return true;
}

Step BlendUnit::flush(Cycle now) {
  if (cache_.flush(now)) return busy(cache_.next_flush());
  flushing_ = false;
  completion().finish(now);
  return busy(now + 1);
}

Step BlendUnit::advance(Cycle now) {
  if (flushing_) return flush(now);
  in_the_way_ = nullptr;
  bool moved = false;
  for (int i = 0; i < quads_per_clock_ && leave(now); ++i) moved = true;
  for (int i = 0; i < quads_per_clock_ && enter(now); ++i) moved = true;
  if (moved) return busy(now + 1);

  Cycle next = kNever;
  if (in_the_way_) {
    next = cache_.next_try();
  } else if (cache_.has_room()) {
    next = in_->next_visible();
  }
  if (cache_.empty()) return in_the_way_ ? blocked(*in_the_way_, next) : nothing_to_take(next);
  return blocked(cache_.server(), std::min(next, cache_.next_ready()));
}

std::vector<Statistic> BlendUnit::statistics() const {
  return {{"quads", "quads", "written", quads_},
          {"misses", "lines", "that the colour cache did not hold", cache_.misses()},
          {"write_backs", "lines", "written to memory", cache_.write_backs()}};
}

std::string BlendUnit::state() const {
  return cache_.empty() ? "" : "oldest quad " + std::to_string(cache_.oldest());
}

}  // namespace splatscope::sim
