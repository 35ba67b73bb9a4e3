#include "sim/fidelity/traffic.h"

#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
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

// look(triangle, its quads, their texel blocks) for each sampled triangle.
template <typename Look>
void each_sample(const DrawWork& work, Look look) {
  const QuadWork* quad = work.quads.data();
  const std::uint32_t* block = work.texel_blocks.data();
  for (std::size_t triangle = 0; triangle < work.triangles.size(); triangle = work.next_recorded(triangle)) {
    const std::span quads(quad, work.triangles[triangle].quad_count);
    std::size_t blocks = 0;
    for (const QuadWork& each : quads) blocks += each.texel_block_count;
    if (work.is_sampled(triangle)) look(triangle, quads, std::span(block, blocks));
    quad += quads.size();
    block += blocks;
  }
}

}  // namespace

double in_bursts(double bytes, const Machine& machine) {
  return std::ceil(bytes / machine.memory.burst_bytes) * machine.memory.burst_bytes;
}

TrafficCounter::TrafficCounter(const Machine& machine, const MemoryLayout& layout)
    : machine_(machine), layout_(layout), is_clear_(layout.depth.lines(), 0) {}

// Depth and what lies behind it share no cache.
Traffic TrafficCounter::of(const DrawJob& job) {
  Traffic traffic;
  tbb::parallel_invoke([&] { count_depth(job, traffic); }, [&] { count_color(job, traffic); });
  return traffic;
}

void TrafficCounter::count_depth(const DrawJob& job, Traffic& traffic) {
  if (!uses_depth(*job.draw)) return;
  const DrawWork& work = *job.work;
  const double line_bytes = in_bursts(layout_.depth.line_bytes(), machine_);
  CacheTags cache(machine_.depth.cache_lines, machine_.depth.cache_ways);
  auto clear = work.clear_tiles.begin();
  double count = 0, bytes = 0;
  each_sample(work,
              [&](std::size_t triangle, std::span<const QuadWork> quads, std::span<const std::uint32_t>) {
                const auto first = clear;
                for (; clear != work.clear_tiles.end() && clear->triangle <= triangle; ++clear)
                  is_clear_[clear->tile] = cleared_;
                for (const QuadWork& quad : quads) {
                  const bool is_written = job.draw->state.depth_write && quad.passed != 0;
                  const std::uint32_t line = layout_.depth.line_of(quad);
                  bytes += touch(cache, line, is_clear_[line] != 0 ? 0 : line_bytes, line_bytes, is_written);
                  if (is_written) is_clear_[line] = 0;
                }
                count += static_cast<double>(quads.size());
                for (const ClearTile& tile : std::span(first, clear)) is_clear_[tile.tile] = 0;
              });
  traffic.depth = bytes / std::max(1.0, count);
}

void TrafficCounter::count_color(const DrawJob& job, Traffic& traffic) const {
  const Draw& draw = *job.draw;
  if (!draw.state.color_write) return;
  const double line_bytes = in_bursts(layout_.color.line_bytes(), machine_);
  const double read_bytes = draw.state.blend ? line_bytes : 0;
  const double fill_bytes =
      in_bursts(draw.source ? machine_.texture.line_bytes : machine_.texture.fill_bytes, machine_);
  const int line_shift =
      std::countr_zero(static_cast<unsigned>(machine_.texture.line_bytes) / kTexelBlockBytes);
  CacheTags color(machine_.blend.cache_lines, machine_.blend.cache_ways);
  CacheTags texture(machine_.texture.cache_lines, machine_.texture.cache_ways);
  double count = 0;
  each_sample(*job.work,
              [&](std::size_t, std::span<const QuadWork> quads, std::span<const std::uint32_t> blocks) {
                traffic.texel_blocks += static_cast<double>(blocks.size());
                for (const std::uint32_t block : blocks)
                  traffic.texture += touch(texture, block >> line_shift, fill_bytes, 0, false);
                for (const QuadWork& quad : quads) {
                  if (!is_colored(job, quad)) continue;
                  ++count;
                  traffic.color += touch(color, layout_.color.line_of(quad), read_bytes, line_bytes, true);
                }
              });
  for (double* of_all : {&traffic.color, &traffic.texture, &traffic.texel_blocks})
    *of_all /= std::max(1.0, count);
}

}  // namespace splatscope::sim
