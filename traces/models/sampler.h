#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "traces/models/mesh_sample.h"

// Priority-based stratified sampling of a mesh (hybrid scenes, section 3): points spread by priority, and
// exactly as many as asked for.
namespace splatscope::traces {

// A leaf of the tree, as the priority and the distribution see it.
struct SampledCell {
  glm::dvec3 center{};                       // object units
  glm::dvec3 dimensions{};                   // along x, y, z
  std::span<const std::uint32_t> triangles;  // that overlap it
  std::size_t unsampled = 0;                 // of these
  std::size_t samples = 0;                   // points taken from this cell
  std::size_t number = 0;                    // of the cell, in the order of the tree
};

// How urgent one more point in this cell is; the highest goes first. Not NaN.
using Priority = std::function<double(const SampledCell&)>;
// Where in the cell a point is placed before it is projected onto the surface: 0 to 1 along each axis.
// `index` counts the places tried in this cell.
using Distribution = std::function<glm::dvec3(const SampledCell&, std::size_t index)>;

// The number of un-sampled triangles. A point samples the triangles of its cell that are nearer to it than
// half the cell; where none is left, the cells with the fewest points go first. Before all of them go cells
// without a point, or finely cut places would take the points of coarse ones and leave holes there.
double unsampled_triangles(const SampledCell& cell);

// A sequence of low discrepancy, shifted at random from cell to cell.
glm::dvec3 even_distribution(const SampledCell& cell, std::size_t index);

inline constexpr int kRelaxations = 3;

struct SamplerOptions {
  std::size_t count = 0;
  int depth = std::numeric_limits<int>::max();  // of the tree at most; it has at most `count` leaves anyway
  Priority priority = unsampled_triangles;
  Distribution distribution = even_distribution;
  int relaxations = kRelaxations;  // rounds in which the points give way to each other (relax.h)
};

struct MeshSamples {
  std::vector<MeshSample> points;
  // Of the last of them, which found no place of their own: the number of the point that each is a copy of.
  // Empty unless the mesh has hardly as many places that differ in binary32.
  std::vector<std::uint32_t> copy_of;

  std::size_t distinct() const { return points.size() - copy_of.size(); }
};

// Exactly `count` points, ordered by cells so that neighbours are near each other in memory. Of a few places
// in the chosen cell, each projected to the closest point of the cell's triangles, the one furthest from the
// points around is taken; then the points give way to each other along the surface. No two have the same
// position but where copy_of says so. Needs a mended mesh (mesh.h) with at least one triangle, or count 0.
// The same result for any number of threads; `priority` and `distribution` may be called from several at
// once.
MeshSamples sample(const Mesh& mesh, const SamplerOptions& options,
                   const std::function<void(double)>& progress = {});

}  // namespace splatscope::traces
