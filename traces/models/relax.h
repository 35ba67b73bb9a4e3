#pragma once

#include <vector>

#include "traces/models/mesh_sample.h"
#include "traces/models/voxels.h"

namespace splatscope::traces {

// Spreads points more evenly over the surface: in each round every point gives way to those nearer than 1.2
// times its distance to the eighth neighbour, the more the nearer they are, and is projected back to the
// surface. Stratified samples leave the sums of the splats' filters some 10% uneven from point to point,
// which the normalisation per surfel shows as speckle; three rounds make 4% of that. How dense the points are
// from one region to another hardly changes. Points whose triangles face opposite ways, on the two sides of a
// thin wall, do not see each other. `index` is that of `voxels`. The result does not depend on the number of
// threads.
void relax(const TriangleCorners& mesh, const Voxels& voxels, const VoxelIndex& index, int rounds,
           std::vector<MeshSample>& points);

}  // namespace splatscope::traces
