#include "sim/units/cache/cached_unit.h"

#include <algorithm>

namespace splatscope::sim {

Step CachedUnit::waiting(Cycle now, const Items* out) {
  Cycle next = kNever;
  if (in_the_way_) {
    next = cache_.next_try();
  } else if (cache_.has_room()) {
    next = in_->next_visible();
  }
  if (cache_.empty()) return in_the_way_ ? blocked(*in_the_way_, next) : nothing_to_take(next);
  if (out && cache_.is_ready(now)) return blocked(out->consumer(), std::min(next, out->next_free()));
  return blocked(cache_.server(), std::min(next, cache_.next_ready()));
}

std::string CachedUnit::state() const {
  return cache_.empty() ? "" : "oldest quad " + std::to_string(cache_.oldest());
}

Step FrameUnit::flush(Cycle now) {
  if (cache_.flush(now)) return busy(cache_.next_flush());
  flushing_ = false;
  completion().finish(now);
  return busy(now + 1);
}

Step FrameUnit::advance(Cycle now) {
  if (flushing_) return flush(now);
  in_the_way_ = nullptr;
  bool moved = false;
  for (int i = 0; i < quads_per_clock_ && leave(now); ++i) moved = true;
  for (int i = 0; i < quads_per_clock_ && enter(now); ++i) moved = true;
  return moved ? busy(now + 1) : waiting(now, out_);
}

}  // namespace splatscope::sim
