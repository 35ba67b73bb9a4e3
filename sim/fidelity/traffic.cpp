#include "sim/fidelity/traffic.h"

#include <algorithm>

#include "sim/units/cache/cache_tags.h"

namespace splatscope::sim {
namespace {

constexpr std::size_t kRun = 1024;  // quads looked up in a row
constexpr std::size_t kRunsApart = 8;

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

TrafficCounter::TrafficCounter(const Machine& machine, const MemoryLayout& layout)
    : machine_(machine), layout_(layout), cleared_(layout.depth.lines(), 0) {}

void TrafficCounter::clear() {
  std::ranges::fill(cleared_, machine_.depth.fast_clear);
}

Traffic TrafficCounter::of(const DrawJob& job) {
  const DrawState& state = job.draw->state;
  const double depth_bytes = layout_.depth.line_bytes(), color_bytes = layout_.color.line_bytes();
  const auto blocks_a_line = static_cast<std::uint32_t>(machine_.texture.line_bytes / 16);
  CacheTags depth(machine_.depth.cache_lines, machine_.depth.cache_ways);
  CacheTags color(machine_.blend.cache_lines, machine_.blend.cache_ways);
  CacheTags texture(machine_.texture.cache_lines, machine_.texture.cache_ways);
  const double fill_bytes = job.draw->source ? machine_.texture.line_bytes : machine_.texture.fill_bytes;
  Traffic sum;
  double quads = 0, colored = 0;
  const std::uint32_t* blocks = job.work->texel_blocks.data();
  for (std::size_t q = 0; q < job.work->quads.size(); ++q) {
    const QuadWork& quad = job.work->quads[q];
    const std::uint32_t* const blocks_end = blocks + quad.texel_block_count;
    const bool writes_depth = state.depth_write && quad.passed != 0;
    const std::uint32_t line = layout_.depth.line_of(quad);
    const bool read_depth = cleared_[line] == 0;
    if (writes_depth) cleared_[line] = 0;
    if (q / kRun % kRunsApart == 0) {
      ++quads;
      if (uses_depth(*job.draw))
        sum.depth += touch(depth, line, read_depth ? depth_bytes : 0, depth_bytes, writes_depth);
      if (is_colored(job, quad)) {
        ++colored;
        sum.color += touch(color, line, state.blend ? color_bytes : 0, color_bytes, true);
        for (const std::uint32_t* block = blocks; block != blocks_end; ++block) {
          sum.texture += touch(texture, *block / blocks_a_line, fill_bytes, 0, false);
        }
      }
    }
    blocks = blocks_end;
  }
  if (quads > 0) sum.depth /= quads;
  if (colored > 0) {
    sum.color /= colored;
    sum.texture /= colored;
  }
  return sum;
}

}  // namespace splatscope::sim
