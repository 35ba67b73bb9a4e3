#pragma once

#include <filesystem>
#include <vector>

#include "traces/models/mesh.h"

namespace splatscope::traces {

struct MeshFile {
  Model model;                               // unmended; colours from texture, vertex colours or material
  std::size_t faces_out_of_range = 0;        // left out already: an index beyond the vertices
  std::size_t textures_unreadable = 0;       // the material's colour stands in
  std::size_t materials_unreadable = 0;      // files of an OBJ file: light grey stands in
  std::vector<std::filesystem::path> files;  // itself and what it names: materials, buffers, all textures
};

// Whether a surfel file is a mesh: a PLY with faces, or any other ending. Throws UserError where a PLY's
// header is wrong.
bool is_mesh_file(const std::filesystem::path& path);

// Any format of assimp, told by the file's ending. Textures are found beside the mesh. Throws UserError:
// missing, unknown format, broken, a PLY or OFF file that is not what its header says, more than
// kMostTriangles, no triangles, so deep or so often repeated that assimp fails. Memory is bounded by a
// multiple of the file's size: counts that a PLY or OFF file cannot hold are refused, and formats that nest
// are tried in a process of its own first (model/processes.h).
MeshFile read_mesh(const std::filesystem::path& path);

inline constexpr std::size_t kMostTriangles = 64'000'000;

}  // namespace splatscope::traces
