#pragma once

#include <filesystem>
#include <vector>

#include "kernels/reference/volume/volume.h"

namespace splatscope::traces {

// Reads an irregular data set from a PLY file (point_file.h): of each vertex its place x y z, its `value`,
// and as `radius` the spacing of the samples about it, which is the standard deviation of its kernel (times
// the root of `kernel_variance`) and whose cube is its cell; nx ny nz, where it has them, point along the
// gradient. Throws UserError as read_ply does, and where there is no sample, value or radius, or one is not
// finite or a radius not above 0.
std::vector<kernels::VolumeSample> read_samples(const std::filesystem::path& path, double kernel_variance);

}  // namespace splatscope::traces
