#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "kernels/reference/volume/volume.h"

namespace splatscope::traces {

// Reads a volume from a NRRD file: raw encoding, three dimensions, integers of 8 to 32 bits and floats of 32
// and 64; header and data in one file, or a header (.nhdr) that names a raw file beside it. The volume's
// middle becomes the object space's origin. Throws UserError: "file:line: ..." for the header
// (nrrd_header.h); "file: ..." where data are missing, too few, or not finite, with the voxel. Nothing is
// allocated before the sizes agree with the file's.
kernels::Volume read_nrrd(const std::filesystem::path& path);

// Where the data of a NRRD file that was read are: in the raw file that its header names, or in itself.
std::filesystem::path nrrd_data_file(const std::filesystem::path& path, int components);

// Places of voxels, object units; x varies fastest, then y.
struct VoxelPositions {
  glm::ivec3 size{};
  std::vector<float> values;  // x y z of each voxel, finite
  glm::dvec3 at(const glm::ivec3& voxel) const;
};

// The same of a file with four dimensions, the first of them 3: where the voxels of a curvilinear grid stand.
VoxelPositions read_nrrd_positions(const std::filesystem::path& path);

}  // namespace splatscope::traces
