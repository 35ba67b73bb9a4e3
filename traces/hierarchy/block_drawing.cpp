#include "traces/hierarchy/block_drawing.h"

#include <fmt/format.h>

#include <algorithm>

#include "traces/hierarchy/block_culling.h"

namespace splatscope::traces {
namespace {

void append(const Block& block, double depth_offset, std::vector<DrawnRange>& ranges) {
  constexpr auto kBuffer = static_cast<std::uint32_t>(kSurfelsADraw);
  for (std::uint32_t first = block.first, end = block.first + block.count; first < end;) {
    const std::uint32_t buffer = first / kBuffer, start = first % kBuffer;
    const std::uint32_t count = std::min(end - first, kBuffer - start);
    if (!ranges.empty() && ranges.back().buffer == buffer &&
        ranges.back().first + ranges.back().count == start) {
      ranges.back().count += count;
    } else {
      ranges.push_back({buffer, start, count, depth_offset});
    }
    first += count;
  }
}

}  // namespace

std::string describe(const BlockCounts& counts) {
  return fmt::format("{} blocks drawn, {} outside the frustum, {} facing away", counts.drawn,
                     counts.outside_frustum, counts.facing_away);
}

std::vector<SurfelBuffer> pack(const TreeLevel& level, std::span<const VertexWeights> weights) {
  std::vector<SurfelBuffer> buffers;
  for (std::size_t first = 0; first < level.surfels.size(); first += kSurfelsADraw) {
    const std::size_t count = std::min(kSurfelsADraw, level.surfels.size() - first);
    buffers.push_back({std::span(level.surfels).subspan(first, count), weights.subspan(first, count)});
  }
  return buffers;
}

std::vector<DrawnRange> draw_finest(const LdcTree& tree, const kernels::View& view, const Splatting& settings,
                                    Culling culling, BlockCounts& counts) {
  std::vector<DrawnRange> ranges;
  if (tree.levels.empty()) return ranges;
  const BlockCulling cull(view, settings);
  for (const Block& block : tree.levels.front().blocks) {
    const BlockFate fate = culling == Culling::blocks ? cull.fate(block) : BlockFate::drawn;
    counts.outside_frustum += fate == BlockFate::outside_frustum;
    counts.facing_away += fate == BlockFate::facing_away;
    if (fate != BlockFate::drawn) continue;
    ++counts.drawn;
    counts.surfels += block.count;
    append(block, settings.depth_offset, ranges);
  }
  return ranges;
}

}  // namespace splatscope::traces
