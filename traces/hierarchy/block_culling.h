#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "kernels/view.h"
#include "traces/hierarchy/ldc_tree.h"

namespace splatscope::traces {

enum class BlockFate { drawn, outside_frustum, facing_away };

// Between the normals of surfels and the rays from the eye to them, where all face away (toward the eye); not
// positive where some may not, or nothing is known.
struct LeastCosines {
  double away = -1, toward = -1;
};

// Which blocks a view need not draw (Ren 2002, section 6.2). Conservative: a block is culled only where no
// quad of its surfels, in either pass, can reach a pixel; the picture stays the same bit for bit.
class BlockCulling {
 public:
  // `settings`: which faces are drawn, and how far splats reach. The view is rigid, as view_of makes it.
  BlockCulling(const kernels::View& view, const Splatting& settings);

  // `known` of the surfels from the splats' eye: in, by the blocks that it is below; out, by this one too.
  BlockFate fate(const Block& block, LeastCosines& known) const;

 private:
  struct Placed;  // a block as the camera sees it
  BlockFate fate(const Block& block, const kernels::View& view, LeastCosines& known) const;
  Placed place(const Block& block, const LeastCosines& known, const kernels::View& view) const;
  bool is_outside(const Placed& placed, const kernels::View& view) const;
  bool faces_away(const Block& block, const Placed& placed, const kernels::View& view) const;

  std::vector<kernels::View> views_;  // of the passes, where they differ
  Splatting settings_;
  std::array<glm::dvec3, 4> sides_;  // unit normals of the frustum's planes through the eye, outward
};

}  // namespace splatscope::traces
