#include "kernels/reference/volume/volume.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "model/stop.h"

namespace splatscope::kernels {
namespace {

// `at` of the voxel's neighbours along an axis, subtracted and divided by the voxels between them.
template <class At>
auto difference(const Volume& volume, const glm::ivec3& voxel, int axis, const At& at) {
  glm::ivec3 before = voxel, after = voxel;
  before[axis] = std::max(0, voxel[axis] - 1);
  after[axis] = std::min(volume.size[axis] - 1, voxel[axis] + 1);
  return (at(after) - at(before)) / static_cast<double>(std::max(1, after[axis] - before[axis]));
}

}  // namespace

Volume centered_volume(const glm::ivec3& size, const glm::dvec3& spacing) {
  Volume volume;
  volume.size = size;
  volume.spacing = spacing;
  volume.origin = -0.5 * glm::dvec3(size - 1) * spacing;
  volume.values.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                       static_cast<std::size_t>(size.z));
  return volume;
}

glm::dvec3 gradient(const Volume& volume, const glm::ivec3& voxel) {
  glm::dvec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = [&](const glm::ivec3& at) { return static_cast<double>(volume.value(at)); };
    result[axis] = difference(volume, voxel, axis, value) / volume.spacing[axis];
  }
  return result;
}

glm::dmat3 grid_variance(const Volume& volume, double kernel_variance) {
  glm::dmat3 variance(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    variance[axis][axis] = kernel_variance * volume.spacing[axis] * volume.spacing[axis];
  }
  return variance;
}

glm::dmat3 cell_edges(const Volume& grid, const glm::ivec3& voxel, const VoxelPlaces& places) {
  glm::dmat3 edges;
  for (int axis = 0; axis < 3; ++axis) edges[axis] = difference(grid, voxel, axis, places);
  return edges;
}

double LayerFacing::least_along(const glm::dvec3& direction) const {
  const glm::dvec3 least = glm::min(direction * normals.low, direction * normals.high);
  return least.x + least.y + least.z;
}

PlacedSamples curvilinear_samples(const Volume& grid, double kernel_variance, const VoxelPlaces& places,
                                  const std::function<bool(float)>& seen) {
  PlacedSamples result;
  glm::ivec3 voxel;
  for (voxel.z = 0; voxel.z < grid.size.z; ++voxel.z) {
    stop_if_asked();
    for (voxel.y = 0; voxel.y < grid.size.y; ++voxel.y) {
      for (voxel.x = 0; voxel.x < grid.size.x; ++voxel.x) {
        if (seen && !seen(grid.value(voxel))) continue;
        const glm::dmat3 edges = cell_edges(grid, voxel, places);
        const double cell = std::abs(glm::determinant(edges));
        VolumeSample sample{.position = places(voxel),
                            .variance = kernel_variance * (edges * glm::transpose(edges)),
                            .cell = cell,
                            .value = grid.value(voxel)};
        if (cell > 0) {
          // Normals and gradients by the place: the transposed inverse of the Jacobian.
          const glm::dmat3 normals = glm::inverse(glm::transpose(edges));
          sample.gradient = normals * (gradient(grid, voxel) * grid.spacing);
          for (int axis = 0; axis < 3; ++axis)
            result.layers.facing[static_cast<std::size_t>(axis)].normals.add(glm::normalize(normals[axis]));
        }
        result.samples.push_back(sample);
        result.layers.voxels.push_back(voxel);
      }
    }
  }
  return result;
}

glm::dmat3 flattened(const glm::dmat3& variance, const glm::dvec3& normal, double s) {
  const glm::dmat3 squeeze = glm::dmat3(1.0) - (1 - 1 / s) * glm::outerProduct(normal, normal);
  return squeeze * variance * squeeze;
}

double flattened_weight(double cosine, double s) {
  const double squared = std::min(cosine * cosine, 1.0);
  return std::sqrt(squared + (1 - squared) / (s * s));
}

}  // namespace splatscope::kernels
