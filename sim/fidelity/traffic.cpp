#include "sim/fidelity/traffic.h"

#include <oneapi/tbb/parallel_invoke.h>

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

// look(quad, texel blocks, whether its triangle is sampled, triangle) for each quad of the record.
template <typename Look>
void each_quad(const DrawWork& work, Look look) {
  auto quad = work.quads.begin();
  const std::uint32_t* block = work.texel_blocks.data();
  for (std::size_t triangle = 0; triangle < work.triangles.size(); triangle = work.next_recorded(triangle)) {
    const bool sampled = is_sampled(triangle);
    for (const auto end = quad + work.triangles[triangle].quad_count; quad != end; ++quad) {
      look(*quad, std::span(block, quad->texel_block_count), sampled, triangle);
      block += quad->texel_block_count;
    }
  }
}

}  // namespace

TrafficCounter::TrafficCounter(const Machine& machine, const MemoryLayout& layout)
    : machine_(machine), layout_(layout), cleared_(layout.depth.lines(), 0) {}

void TrafficCounter::clear() {
  std::ranges::fill(cleared_, machine_.depth.fast_clear);
}

// Depth and what lies behind it share no cache.
Traffic TrafficCounter::of(const DrawJob& job) {
  Traffic traffic;
  tbb::parallel_invoke([&] { count_depth(job, traffic); }, [&] { count_color(job, traffic); });
  return traffic;
}

void TrafficCounter::count_depth(const DrawJob& job, Traffic& traffic) {
  const DrawWork& work = *job.work;
  const bool reads = uses_depth(*job.draw), writes = job.draw->state.depth_write;
  const double line_bytes = layout_.depth.line_bytes();
  CacheTags cache(machine_.depth.cache_lines, machine_.depth.cache_ways);
  auto written = work.tiles_written.begin();
  const auto note_written = [&](std::size_t up_to) {
    for (; written != work.tiles_written.end() && written->triangle <= up_to; ++written)
      cleared_[written->tile] = 0;
  };
  double quads = 0, bytes = 0;
  each_quad(work,
            [&](const QuadWork& quad, std::span<const std::uint32_t>, bool sampled, std::size_t triangle) {
              note_written(triangle);
              const bool is_written = writes && quad.passed != 0;
              const std::uint32_t line = layout_.depth.line_of(quad);
              if (sampled) {
                ++quads;
                if (reads)
                  bytes += touch(cache, line, cleared_[line] != 0 ? 0 : line_bytes, line_bytes, is_written);
              }
              if (is_written) cleared_[line] = 0;
            });
  note_written(work.triangles.size());
  traffic.depth = bytes / std::max(1.0, quads);
}

void TrafficCounter::count_color(const DrawJob& job, Traffic& traffic) const {
  const Draw& draw = *job.draw;
  if (!draw.state.color_write) return;
  const double line_bytes = layout_.color.line_bytes(), read_bytes = draw.state.blend ? line_bytes : 0;
  const double fill_bytes = draw.source ? machine_.texture.line_bytes : machine_.texture.fill_bytes;
  const int line_shift =
      std::countr_zero(static_cast<unsigned>(machine_.texture.line_bytes / 16));  // of blocks
  CacheTags color(machine_.blend.cache_lines, machine_.blend.cache_ways);
  CacheTags texture(machine_.texture.cache_lines, machine_.texture.cache_ways);
  double quads = 0;
  each_quad(*job.work,
            [&](const QuadWork& quad, std::span<const std::uint32_t> blocks, bool sampled, std::size_t) {
              if (!sampled || !is_colored(job, quad)) return;
              ++quads;
              traffic.color += touch(color, layout_.depth.line_of(quad), read_bytes, line_bytes, true);
              traffic.texel_blocks += static_cast<double>(blocks.size());
              for (const std::uint32_t block : blocks)
                traffic.texture += touch(texture, block >> line_shift, fill_bytes, 0, false);
            });
  for (double* of_all : {&traffic.color, &traffic.texture, &traffic.texel_blocks})
    *of_all /= std::max(1.0, quads);
}

}  // namespace splatscope::sim
