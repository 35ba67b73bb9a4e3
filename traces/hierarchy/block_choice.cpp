#include "traces/hierarchy/block_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "traces/hierarchy/block_culling.h"

namespace splatscope::traces {
namespace {

// One frame, whose blocks are refined down to `finest` at most.
class Walk {
 public:
  Walk(const LdcTree& tree, const kernels::View& view, const Splatting& splatting, const Hierarchy& hierarchy,
       std::size_t finest)
      : tree_(tree),
        view_(view),
        hierarchy_(hierarchy),
        finest_(finest),
        same_eye_(splatting.depth_offset_scheme == DepthOffsetScheme::viewing_ray) {
    frame_.counts.surfels_by_level.resize(tree.levels.size());
    for (std::size_t level = 0; level < tree.levels.size(); ++level)
      culling_.emplace_back(view, level_splatting(splatting, level));
    const std::size_t root = tree.levels.size() - 1;
    for (const Block& block : tree.levels[root].blocks) visit(root, block);
  }

  ChosenFrame take() { return std::move(frame_); }

 private:
  // `known`: by the blocks that it is below.
  void visit(std::size_t level, const Block& block, LeastCosines known = {}) {
    BlockCounts& counts = frame_.counts;
    const bool refine = level > finest_ && !fine_enough(level, block);
    if (hierarchy_.culling == Culling::blocks && (!refine || same_eye_)) {
      const BlockFate fate = culling_[level].fate(block, known);
      if (fate == BlockFate::outside_frustum) counts.outside_frustum += block.below;
      if (fate == BlockFate::facing_away) counts.facing_away += block.below;
      if (fate != BlockFate::drawn) return;
    }
    if (refine) {
      const std::vector<Block>& finer = tree_.levels[level - 1].blocks;
      for (std::uint32_t i = 0; i < block.children; ++i)
        visit(level - 1, finer[block.first_child + i], known);
      return;
    }
    ++counts.blocks;
    counts.surfels += block.count;
    counts.surfels_by_level[level] += block.count;
    append(level, block);
  }

  bool fine_enough(std::size_t level, const Block& block) const {
    if (!hierarchy_.levels) return false;
    const double pixels = projected_spacing(block, tree_.levels[level].spacing, view_);
    return pixels * pixels * hierarchy_.surfels_per_pixel <= 1;
  }

  void append(std::size_t level, const Block& block) {
    std::vector<BlockRange>& ranges = frame_.ranges;
    if (!ranges.empty() && ranges.back().level == level &&
        ranges.back().first + ranges.back().count == block.first) {
      ranges.back().count += block.count;
    } else {
      ranges.push_back({level, block.first, block.count});
    }
  }

  const LdcTree& tree_;
  const kernels::View& view_;
  const Hierarchy& hierarchy_;
  std::size_t finest_;
  bool same_eye_;  // for the visibility passes of all levels: what culls a block culls what is below it
  std::vector<BlockCulling> culling_;  // by level
  ChosenFrame frame_;
};

}  // namespace

std::string describe(const BlockCounts& counts) {
  std::string text =
      fmt::format("{} surfels in {} blocks drawn; culled: {} surfels outside the frustum, {} facing away",
                  counts.surfels, counts.blocks, counts.outside_frustum, counts.facing_away);
  if (!counts.surfels_by_level.empty() && counts.surfels_by_level.front() != counts.surfels)
    text += fmt::format("; by level, the finest first: {}", fmt::join(counts.surfels_by_level, ", "));
  return text;
}

Splatting level_splatting(const Splatting& splatting, std::size_t level) {
  Splatting settings = splatting;
  settings.depth_offset *= std::exp2(static_cast<double>(level));
  return settings;
}

double projected_spacing(const Block& block, double spacing, const kernels::View& view) {
  std::array<glm::dvec2, 8> window;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < window.size(); ++i) {
    const glm::dvec3 corner = view.camera_space(block.box.corner(i));
    nearest = std::min(nearest, corner.z);
    // Not at the near plane: clip planes fitted to the surfels cut the boxes of the blocks in front.
    if (!(nearest > 0)) return std::numeric_limits<double>::infinity();
    window[i] = view.window(corner);
  }
  const double diagonal = glm::length(block.box.size());
  if (!(diagonal > 0)) return spacing * view.eta / nearest;  // a single surfel
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) longest = std::max(longest, glm::length(window[i] - window[7 - i]));
  return spacing * longest / diagonal;
}

std::vector<ChosenFrame> choose_blocks(const LdcTree& tree, const kernels::View& view,
                                       const Splatting& splatting, const Hierarchy& hierarchy) {
  std::vector<ChosenFrame> frames;
  if (tree.levels.empty()) return std::vector<ChosenFrame>(1);
  for (std::size_t level = hierarchy.progressive ? tree.levels.size() : 1; level-- > 0;) {
    ChosenFrame frame = Walk(tree, view, splatting, hierarchy, level).take();
    // Levels that every block was fine enough without.
    const bool same =
        !frames.empty() && frame.counts.surfels_by_level == frames.back().counts.surfels_by_level;
    if (!same) frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace splatscope::traces
