#pragma once

#include <span>
#include <vector>

#include "traces/scene.h"

namespace splatscope::traces {

// Which surfels lie at an edge of the model, where the surface ends: those that see none of their 16 nearest
// neighbours in 135 degrees or more of their tangent plane. A straight edge leaves 180 degrees free and a
// corner more; inside, 16 neighbours in directions quite at random would leave 135 degrees free once in 70
// times. Neighbours that face the other way belong to the other side of a thin part and do not count; at a
// crease the other face's neighbours do, for there the surface goes on. Positions must be finite and normals
// of unit length.
std::vector<char> at_edge(std::span<const Surfel> surfels);

}  // namespace splatscope::traces
