#include "traces/models/voxels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

#include "kernels/bounds.h"
#include "model/stop.h"

namespace splatscope::traces {
namespace {

// A little larger than the mesh, and not the same on both sides: a face of a tidy model then does not lie
// exactly between two cells, where it would fill both.
Voxels root_of(const TriangleCorners& mesh) {
  kernels::Box box;
  for (const auto& corners : mesh)
    for (const glm::vec3& corner : corners) box.add(glm::dvec3(corner));
  const double diagonal = glm::length(box.size());
  Voxels root;
  root.low = box.low - 0.0010 * diagonal;
  root.size = box.high + 0.0023 * diagonal - root.low;
  root.cells = {glm::uvec3(0)};
  root.triangles.resize(mesh.size());
  std::iota(root.triangles.begin(), root.triangles.end(), 0u);
  root.first = {0, root.triangles.size()};
  return root;
}

// Consecutive leaves of a level.
struct Part {
  std::vector<glm::uvec3> cells;
  std::vector<std::size_t> counts;  // of triangles
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> upper;  // of the cell being halved
};

// The halves of one cell that triangles overlap.
void halve(const TriangleCorners& mesh, const Voxels& parents, const Voxels& children, int axis,
           std::size_t cell, Part& out) {
  glm::uvec3 place = parents.cells[cell];
  place[axis] *= 2;
  const double middle = children.low[axis] + (place[axis] + 1) * children.size[axis];
  const glm::dvec3 half = 0.5 * children.size;
  const glm::dvec3 lower = children.low + (glm::dvec3(place) + 0.5) * children.size;
  glm::dvec3 upper = lower;
  upper[axis] += children.size[axis];
  out.upper.clear();
  const std::size_t before = out.triangles.size();
  for (std::uint32_t number : parents.triangles_of(cell)) {
    const Triangle t = triangle_of(mesh, number);
    // It overlaps the cell: where it is on one side of the middle it overlaps that half alone.
    const auto [least, most] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    if (most < middle || (least <= middle && overlaps(t, lower, half))) out.triangles.push_back(number);
    if (least > middle || (most >= middle && overlaps(t, upper, half))) out.upper.push_back(number);
  }
  const auto end_cell = [&](std::size_t count) {
    if (count == 0) return;
    out.cells.push_back(place);
    out.counts.push_back(count);
  };
  end_cell(out.triangles.size() - before);
  ++place[axis];
  end_cell(out.upper.size());
  out.triangles.insert(out.triangles.end(), out.upper.begin(), out.upper.end());
}

Voxels next_level(const TriangleCorners& mesh, const Voxels& parents, int axis) {
  Voxels children;
  children.low = parents.low;
  children.size = parents.size;
  children.size[axis] *= 0.5;
  constexpr std::size_t kParts = 256;  // at most; their order is the leaves' order
  const std::size_t cells = parents.cells.size(), a_part = (cells + kParts - 1) / kParts;
  std::vector<Part> parts((cells + a_part - 1) / a_part);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    stop_if_asked();
    for (std::size_t cell = part * a_part; cell < std::min((part + 1) * a_part, cells); ++cell)
      halve(mesh, parents, children, axis, cell, parts[part]);
  });
  children.first = {0};
  for (Part& part : parts) {
    children.cells.insert(children.cells.end(), part.cells.begin(), part.cells.end());
    for (std::size_t count : part.counts) children.first.push_back(children.first.back() + count);
    children.triangles.insert(children.triangles.end(), part.triangles.begin(), part.triangles.end());
    part = {};
  }
  return children;
}

// 21 bits an axis: more than kMostHalvings; 0 - 1 has them all and names no cell.
std::uint64_t key(const glm::uvec3& place) {
  const glm::uvec3 bits = place & 0x1fffffu;
  return bits.x | std::uint64_t{bits.y} << 21 | std::uint64_t{bits.z} << 42;
}

}  // namespace

VoxelIndex::VoxelIndex(const Voxels& voxels) {
  numbers_.reserve(voxels.cells.size());
  for (std::uint32_t i = 0; i < voxels.cells.size(); ++i) numbers_.emplace(key(voxels.cells[i]), i);
}

std::uint32_t VoxelIndex::at(const glm::uvec3& place) const {
  const auto found = numbers_.find(key(place));
  return found == numbers_.end() ? kNone : found->second;
}

Voxels voxelize(const TriangleCorners& mesh, int depth, std::size_t most_cells) {
  Voxels voxels = root_of(mesh);
  const std::size_t most_entries = 32 * (mesh.size() + most_cells);
  int halvings[3] = {};
  for (int level = 0; level < depth; ++level) {
    const glm::dvec3& size = voxels.size;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (++halvings[axis] > kMostHalvings) break;
    Voxels children = next_level(mesh, voxels, axis);
    if (children.cells.size() > most_cells || children.triangles.size() > most_entries) break;
    voxels = std::move(children);
  }
  return voxels;
}

}  // namespace splatscope::traces
