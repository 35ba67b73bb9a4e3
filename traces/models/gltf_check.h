#pragma once

#include <filesystem>

namespace splatscope::traces {

// assimp takes the integers that glTF 2.0 may hold in the place of floats (positions and normals of
// KHR_mesh_quantization, any texture coordinates) for coordinates, and passes over extensions that a file
// requires. Throws UserError where the file has such integers, or requires an extension other than of
// materials or lights. What is no glTF 2.0 at all is for assimp to refuse.
void expect_plain_gltf(const std::filesystem::path& path);

}  // namespace splatscope::traces
