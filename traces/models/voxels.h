#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "traces/models/mesh.h"
#include "traces/models/triangle.h"

namespace splatscope::traces {

// The voxel approximation of a mesh (hybrid scenes, 3.1): the leaf cells of a tree whose root is the mesh's
// bounding box. Each level halves every cell across its longest dimension and drops the halves that no
// triangle overlaps, so all leaves have the same size and lie on a grid.
struct Voxels {
  glm::dvec3 low{};                      // corner of the grid, object units
  glm::dvec3 size{};                     // of a cell
  std::vector<glm::uvec3> cells;         // place of each leaf on the grid, in the order of the tree
  std::vector<std::size_t> first;        // of each leaf's triangles in `triangles`; one entry more at the end
  std::vector<std::uint32_t> triangles;  // of all leaves

  glm::dvec3 center(std::size_t cell) const { return low + (glm::dvec3(cells[cell]) + 0.5) * size; }
  std::span<const std::uint32_t> triangles_of(std::size_t cell) const {
    return std::span(triangles).subspan(first[cell], first[cell + 1] - first[cell]);
  }
};

// Finds leaves by their place.
class VoxelIndex {
 public:
  static constexpr std::uint32_t kNone = ~0u;

  explicit VoxelIndex(const Voxels& voxels);

  // The number of the leaf there, or kNone. Places one outside of the grid hold none.
  std::uint32_t at(const glm::uvec3& place) const;

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

inline constexpr int kMostHalvings = 20;  // of each axis

// Halves cells `depth` times, or until one more time would give more than `most_cells`; earlier where an axis
// was halved kMostHalvings times or the lists of triangles outgrow 32 entries a triangle and cell. Needs a
// mended mesh with at least one triangle. The result does not depend on the number of threads.
Voxels voxelize(const TriangleCorners& mesh, int depth, std::size_t most_cells);

inline Triangle triangle_of(const TriangleCorners& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh[triangle];
  return {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)};
}

}  // namespace splatscope::traces
