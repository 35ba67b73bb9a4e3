#include "sim/fidelity/traffic.h"

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

// look(number in the draw, its quads, their texel blocks) for each sampled triangle of a part.
template <typename Look>
void each_sample(const DrawWork& part, std::uint64_t first, Look look) {
  const QuadWork* quad = part.quads.data();
  const std::uint32_t* block = part.texel_blocks.data();
  const std::uint64_t end = first + part.triangles.size();
  for (std::uint64_t triangle = first; triangle < end; triangle = part.next_recorded(triangle)) {
    const std::span quads(quad, part.triangles[triangle - first].quad_count);
    std::size_t blocks = 0;
    for (const QuadWork& each : quads) blocks += each.texel_block_count;
    if (part.is_sampled(triangle)) look(triangle, quads, std::span(block, blocks));
    quad += quads.size();
    block += blocks;
  }
}

}  // namespace

double in_bursts(double bytes, const Machine& machine) {
  return std::ceil(bytes / machine.memory.burst_bytes) * machine.memory.burst_bytes;
}

TrafficCounter::TrafficCounter(const Machine& machine, const MemoryLayout& layout)
    : machine_(machine),
      layout_(layout),
      is_clear_(layout.depth.lines(), 0),
      depth_tags_(machine.depth.cache_lines, machine.depth.cache_ways),
      color_tags_(machine.blend.cache_lines, machine.blend.cache_ways),
      texture_tags_(machine.texture.cache_lines, machine.texture.cache_ways) {}

void TrafficCounter::begin(const DrawJob& job) {
  job_ = &job;
  for (CacheTags* tags : {&depth_tags_, &color_tags_, &texture_tags_}) tags->invalidate(CacheTags::kNoLine);
  depth_ = color_ = {};
  texture_bytes_ = texel_blocks_ = 0;
}

void TrafficCounter::add_depth(const DrawWork& part, std::uint64_t first_triangle) {
  if (!uses_depth(*job_->draw)) return;
  const double line_bytes = in_bursts(layout_.depth.line_bytes(), machine_);
  auto clear = part.clear_tiles.begin();
  each_sample(part, first_triangle,
              [&](std::uint64_t triangle, std::span<const QuadWork> quads, std::span<const std::uint32_t>) {
                const auto first = clear;
                for (; clear != part.clear_tiles.end() && clear->triangle <= triangle; ++clear)
                  is_clear_[clear->tile] = cleared_;
                for (const QuadWork& quad : quads) {
                  const bool is_written = job_->draw->state.depth_write && quad.passed != 0;
                  const std::uint32_t line = layout_.depth.line_of(quad);
                  depth_.bytes +=
                      touch(depth_tags_, line, is_clear_[line] != 0 ? 0 : line_bytes, line_bytes, is_written);
                  if (is_written) is_clear_[line] = 0;
                }
                depth_.quads += static_cast<double>(quads.size());
                for (const ClearTile& tile : std::span(first, clear)) is_clear_[tile.tile] = 0;
              });
}

void TrafficCounter::add_color(const DrawWork& part, std::uint64_t first_triangle) {
  const Draw& draw = *job_->draw;
  if (!draw.state.color_write) return;
  const double line_bytes = in_bursts(layout_.color.line_bytes(), machine_);
  const double read_bytes = draw.state.blend ? line_bytes : 0;
  const double fill_bytes =
      in_bursts(draw.source ? machine_.texture.line_bytes : machine_.texture.fill_bytes, machine_);
  const int line_shift =
      std::countr_zero(static_cast<unsigned>(machine_.texture.line_bytes) / kTexelBlockBytes);
  each_sample(part, first_triangle,
              [&](std::uint64_t, std::span<const QuadWork> quads, std::span<const std::uint32_t> blocks) {
                texel_blocks_ += static_cast<double>(blocks.size());
                for (const std::uint32_t block : blocks)
                  texture_bytes_ += touch(texture_tags_, block >> line_shift, fill_bytes, 0, false);
                for (const QuadWork& quad : quads) {
                  if (!is_colored(*job_, quad)) continue;
                  ++color_.quads;
                  color_.bytes +=
                      touch(color_tags_, layout_.color.line_of(quad), read_bytes, line_bytes, true);
                }
              });
}

Traffic TrafficCounter::traffic() const {
  const double colored = std::max(1.0, color_.quads);
  return {.depth = depth_.bytes / std::max(1.0, depth_.quads),
          .color = color_.bytes / colored,
          .texture = texture_bytes_ / colored,
          .texel_blocks = texel_blocks_ / colored};
}

}  // namespace splatscope::sim
