#include "sim/units/texture/texture_unit.h"

#include <bit>

namespace splatscope::sim {

TextureUnit::TextureUnit(std::string name, Completion& completion, const Machine::Texture& spec,
                         int quads_per_clock)
    : CachedUnit(std::move(name), completion,
                 {spec.cache_lines, spec.cache_ways, static_cast<std::uint32_t>(spec.line_bytes),
                  static_cast<std::uint32_t>(spec.fill_bytes), spec.pending},
                 quads_per_clock),
      spec_(spec),
      line_shift_(static_cast<std::uint32_t>(
          std::countr_zero(static_cast<unsigned>(spec.line_bytes) / kTexelBlockBytes))) {}

void TextureUnit::connect(const QuadSources& in, Items& out, MemoryPort& port) {
  sources_ = in;
  out_ = &out;
  port_ = &port;
}

void TextureUnit::start(const DrawJob& job) {
  if (!job.textured) return;
  in_ = sources_.of(job);
  cache_.connect(*port_, job.texture_address);
  cache_.set_fill(static_cast<std::uint32_t>(job.draw->source ? spec_.line_bytes : spec_.fill_bytes));
  cache_.invalidate();
  next_block_ = 0;
  blocks_done_ = 0;
}

void TextureUnit::pass(const Cut& cut) {
  for (const std::uint32_t block : cut.blocks) cache_.pass(block >> line_shift_, false);
}

bool TextureUnit::leave(Cycle now) {
  if (cache_.empty() || !cache_.is_ready(now) || !out_->can_push(now)) return false;
  const std::uint32_t quad = cache_.leave();
  out_->push(now, quad);
  event(now, quad);
  ++quads_;
  item_done(now);
  return true;
}

bool TextureUnit::look_up(Cycle now, int& lookups) {
  if (!cache_.has_room() || !in_->can_pop(now)) return false;
  if (blocks_done_ == 0) pass_cuts(in_->front());
  const std::uint32_t blocks = job().quads[in_->front()].texel_block_count;
  for (; blocks_done_ < blocks; ++blocks_done_, --lookups) {
    if (lookups == 0) return true;  // the rest of this quad in the next clock
    in_the_way_ =
        cache_.touch(now, job().texel_blocks[next_block_ + blocks_done_] >> line_shift_, true, false);
    if (in_the_way_) return false;
  }
  next_block_ += blocks;
  blocks_done_ = 0;
  cache_.enter(in_->pop(now));
  return true;
}

Step TextureUnit::advance(Cycle now) {
  if (!in_) return idle();  // before the first draw
  in_the_way_ = nullptr;
  bool moved = false;
  for (int i = 0; i < quads_per_clock_ && leave(now); ++i) moved = true;
  int lookups = spec_.lookups_per_clock;
  for (int i = 0; i < quads_per_clock_ && look_up(now, lookups); ++i) moved = true;
  return moved || lookups != spec_.lookups_per_clock ? busy(now + 1) : waiting(now, out_);
}

std::vector<Statistic> TextureUnit::statistics(Cycle) const {
  return {{"quads", "quads", "passed on", quads_},
          {"lookups", "lines", "looked up in the texture cache", cache_.touches()},
          {"misses", "lines", "read from memory", cache_.misses()}};
}

}  // namespace splatscope::sim
