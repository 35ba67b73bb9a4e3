#include "sim/fidelity/traffic.h"

#include <algorithm>
#include <bit>
#include <span>

#include "sim/units/cache/cache_tags.h"

namespace splatscope::sim {
namespace {

// Bytes that a touch of a line moves: nothing where it is held, else its own, and those of a dirty line that
// makes room.
double touch(CacheTags& tags, std::uint32_t line, double fetched, double written_back, bool dirty) {
  if (CacheTags::Way* way = tags.find(line)) {
    tags.use(*way, dirty);
    return 0;
  }
  CacheTags::Way& way = tags.victim(line);
  const double bytes = fetched + (way.dirty ? written_back : 0);
  tags.take(way, line, dirty);
  return bytes;
}

}  // namespace

// The caches of a draw, and what they have moved.
class TrafficCounter::Caches {
 public:
  Caches(const TrafficCounter& counter, const DrawJob& job)
      : job_(job),
        lines_(counter.layout_.depth),
        uses_depth_(uses_depth(*job.draw)),
        depth_bytes_(lines_.line_bytes()),
        color_bytes_(counter.layout_.color.line_bytes()),
        fill_bytes_(job.draw->source ? counter.machine_.texture.line_bytes
                                     : counter.machine_.texture.fill_bytes),
        line_shift_(std::countr_zero(static_cast<unsigned>(counter.machine_.texture.line_bytes / 16))),
        depth_(counter.machine_.depth.cache_lines, counter.machine_.depth.cache_ways),
        color_(counter.machine_.blend.cache_lines, counter.machine_.blend.cache_ways),
        texture_(counter.machine_.texture.cache_lines, counter.machine_.texture.cache_ways) {}

  void look_up(const QuadWork& quad, std::span<const std::uint32_t> blocks, bool cleared, bool writes_depth) {
    const std::uint32_t line = lines_.line_of(quad);
    ++quads_;
    if (uses_depth_)
      sum_.depth += touch(depth_, line, cleared ? 0 : depth_bytes_, depth_bytes_, writes_depth);
    if (!is_colored(job_, quad)) return;
    ++colored_;
    sum_.color += touch(color_, line, job_.draw->state.blend ? color_bytes_ : 0, color_bytes_, true);
    sum_.texel_blocks += static_cast<double>(blocks.size());
    for (const std::uint32_t block : blocks)
      sum_.texture += touch(texture_, block >> line_shift_, fill_bytes_, 0, false);
  }

  Traffic of_a_quad() const {
    const double quads = std::max(1.0, quads_), colored = std::max(1.0, colored_);
    return {sum_.depth / quads, sum_.color / colored, sum_.texture / colored, sum_.texel_blocks / colored};
  }

 private:
  const DrawJob& job_;
  const FrameLines& lines_;
  bool uses_depth_;
  double depth_bytes_, color_bytes_, fill_bytes_;
  int line_shift_;  // of texel blocks
  CacheTags depth_, color_, texture_;
  Traffic sum_;
  double quads_ = 0, colored_ = 0;
};

TrafficCounter::TrafficCounter(const Machine& machine, const MemoryLayout& layout)
    : machine_(machine), layout_(layout), cleared_(layout.depth.lines(), 0) {}

void TrafficCounter::clear() {
  std::ranges::fill(cleared_, machine_.depth.fast_clear);
}

Traffic TrafficCounter::of(const DrawJob& job) {
  const DrawWork& work = *job.work;
  const bool depth_write = job.draw->state.depth_write;
  Caches caches(*this, job);
  auto written = work.tiles_written.begin();
  auto quad = work.quads.begin();
  const std::uint32_t* block = work.texel_blocks.data();
  const auto note_written = [&](std::size_t up_to) {
    for (; written != work.tiles_written.end() && written->triangle <= up_to; ++written)
      cleared_[written->tile] = 0;
  };
  const std::size_t count = work.triangles.size();
  for (std::size_t triangle = 0; triangle < count; triangle = work.next_recorded(triangle)) {
    const bool sampled = is_sampled(triangle);
    note_written(triangle);
    for (const auto end = quad + work.triangles[triangle].quad_count; quad != end; ++quad) {
      const bool writes_depth = depth_write && quad->passed != 0;
      std::uint8_t& cleared = cleared_[layout_.depth.line_of(*quad)];
      if (sampled) caches.look_up(*quad, {block, quad->texel_block_count}, cleared != 0, writes_depth);
      if (writes_depth) cleared = 0;
      block += quad->texel_block_count;
    }
  }
  note_written(count);
  return caches.of_a_quad();
}

}  // namespace splatscope::sim
