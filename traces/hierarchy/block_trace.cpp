#include "traces/hierarchy/block_trace.h"

#include <algorithm>

namespace splatscope::traces {
namespace {

constexpr auto kBuffer = static_cast<std::uint32_t>(kSurfelsADraw);

std::vector<DrawnRange> drawn_ranges(const ChosenFrame& frame, std::span<const std::uint32_t> first_buffers,
                                     const Splatting& splatting) {
  std::vector<DrawnRange> ranges;
  for (const BlockRange& range : frame.ranges) {
    const double depth_offset = level_splatting(splatting, range.level).depth_offset;
    for (std::uint32_t first = range.first, end = range.first + range.count; first < end;) {
      const std::uint32_t start = first % kBuffer, count = std::min(end - first, kBuffer - start);
      ranges.push_back({first_buffers[range.level] + first / kBuffer, start, count, depth_offset});
      first += count;
    }
  }
  return ranges;
}

}  // namespace

std::vector<std::size_t> levels_of(std::span<const ChosenFrame> frames) {
  std::vector<std::size_t> levels;
  for (const ChosenFrame& frame : frames)
    for (const BlockRange& range : frame.ranges) levels.push_back(range.level);
  std::ranges::sort(levels);
  const auto repeated = std::ranges::unique(levels);
  levels.erase(repeated.begin(), repeated.end());
  return levels;
}

Trace block_trace(const LdcTree& tree, std::span<const ChosenFrame> frames,
                  std::span<const std::vector<VertexWeights>> weights, std::span<const double> still_weights,
                  const kernels::View& view, const Splatting& splatting, const SplatPass& pass) {
  std::vector<SurfelBuffer> buffers;
  std::vector<std::uint32_t> first_buffers(tree.levels.size());
  for (const std::size_t level : levels_of(frames)) {
    first_buffers[level] = static_cast<std::uint32_t>(buffers.size());
    const std::span<const Surfel> surfels = tree.levels[level].surfels;
    for (std::size_t first = 0; first < surfels.size(); first += kBuffer) {
      const std::size_t count = std::min<std::size_t>(kBuffer, surfels.size() - first);
      buffers.push_back({surfels.subspan(first, count), std::span(weights[level]).subspan(first, count),
                         still_weights[level]});
    }
  }
  std::vector<std::vector<DrawnRange>> ranges;
  for (const ChosenFrame& frame : frames) ranges.push_back(drawn_ranges(frame, first_buffers, splatting));
  return splat_trace(buffers, ranges, view, splatting, pass);
}

}  // namespace splatscope::traces
