#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/view.h"
#include "traces/hierarchy/ldc_tree.h"

// Which blocks of a tree a frame draws, and at which level (Ren 2002, section 6.2).
namespace splatscope::traces {

// What became of the surfels of a frame. All 0 where a scene has no hierarchy.
struct BlockCounts {
  std::size_t blocks = 0;                     // drawn
  std::size_t surfels = 0;                    // in these
  std::vector<std::size_t> surfels_by_level;  // the finest first
  // Surfels of the finest level that were not drawn, at whatever level.
  std::size_t outside_frustum = 0;
  std::size_t facing_away = 0;
};

// "68215 surfels in 857 blocks drawn; culled: 0 surfels outside the frustum, 25319 facing away"; with levels,
// what each has.
std::string describe(const BlockCounts& counts);

// Neighbouring surfels of a level.
struct BlockRange {
  std::size_t level = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct ChosenFrame {
  std::vector<BlockRange> ranges;  // in the tree's order; blocks that follow each other are joined
  BlockCounts counts;
};

// Splatting of a level: surfels that lie 2^level times as far apart as the finest need as much more depth
// offset.
Splatting level_splatting(const Splatting& splatting, std::size_t level);

// Distance in pixels between neighbouring surfels of a level where it is largest: by warping the corners of
// the block's box to the screen and taking the longest of its four diagonals (Pfister et al. 2000), in units
// of the level's spacing. Infinite where the box reaches to the eye's plane or behind it; the near plane may
// cut it.
double projected_spacing(const Block& block, double spacing, const kernels::View& view);

// Walks the tree from its root, culls, and stops where `hierarchy` finds a level fine enough. One frame;
// where it is to be progressive, one for each level from the coarsest on, as long as they change.
std::vector<ChosenFrame> choose_blocks(const LdcTree& tree, const kernels::View& view,
                                       const Splatting& splatting, const Hierarchy& hierarchy);

}  // namespace splatscope::traces
