#pragma once

#include <vector>

#include "traces/scene_keys.h"

namespace splatscope::traces {

inline constexpr double kPlaneSpacing = 1;  // object units between neighbouring surfels of a row or column

// `rows` x `columns` surfels on the plane y = 0, centred on the origin, row by row from the smallest z,
// coloured as a checkerboard (Ren 2002, Fig. 11: 256 x 256). The radius reaches the diagonal neighbour.
std::vector<Surfel> make_plane(const SurfelSource& source);

}  // namespace splatscope::traces
