#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "kernels/bounds.h"

namespace splatscope::kernels {

// Voxels on a regular or rectilinear grid (Zwicker 2002, section 6.2). Voxel (i, j, k) stands at origin + (i,
// j, k) * spacing, in object units.
struct Volume {
  glm::ivec3 size{};          // voxels along x, y and z, each >= 1
  glm::dvec3 spacing{1.0};    // object units between neighbours, each > 0
  glm::dvec3 origin{};        // of voxel (0, 0, 0)
  std::vector<float> values;  // finite; x varies fastest, then y

  std::size_t index(const glm::ivec3& voxel) const {
    return (static_cast<std::size_t>(voxel.z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(voxel.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(voxel.x);
  }
  float value(const glm::ivec3& voxel) const { return values[index(voxel)]; }
  glm::dvec3 position(const glm::ivec3& voxel) const { return origin + glm::dvec3(voxel) * spacing; }
  glm::dvec3 extent() const { return glm::dvec3(size) * spacing; }  // a cell about every voxel
  glm::dvec3 center() const { return origin + 0.5 * glm::dvec3(size - 1) * spacing; }
};

// All values 0, centred at the object space's origin.
Volume centered_volume(const glm::ivec3& size, const glm::dvec3& spacing);

// Central differences, one-sided at the faces and 0 along an axis of one voxel; values by object units.
glm::dvec3 gradient(const Volume& volume, const glm::ivec3& voxel);

// The variance of the kernels of a grid (Eq. 25): its squared spacings times `kernel_variance`, which is 1 in
// the paper.
glm::dmat3 grid_variance(const Volume& volume, double kernel_variance);

// A voxel of a curvilinear or irregular data set, or one of a grid with a kernel of its own.
struct VolumeSample {
  glm::dvec3 position{};     // object units
  glm::dmat3 variance{1.0};  // V_k of Eq. 25, object units squared; symmetric, positive definite
  double cell = 1;           // object units cubed that it stands for
  glm::dvec3 gradient{};     // values by object units
  float value = 0;
};

// Where the voxel (i, j, k) of a rectilinear or curvilinear grid stands, object units.
using VoxelPlaces = std::function<glm::dvec3(const glm::ivec3&)>;

// The edges of a voxel's cell: along each axis of such a grid, the difference of places between the voxel's
// neighbours, one-sided at the faces.
glm::dmat3 cell_edges(const Volume& grid, const glm::ivec3& voxel, const VoxelPlaces& places);

// Which way the layers of voxels along one axis of such a grid face: bounds of the unit normals of its cells,
// toward the next layer. Those of a rectilinear grid are all one.
struct LayerFacing {
  Box normals;

  // The least that any of them can have along a direction.
  double least_along(const glm::dvec3& direction) const;
};

// The layers of such a grid along each of its axes.
struct GridLayers {
  std::vector<glm::ivec3> voxels;  // their numbers: those of a voxel's layers
  std::array<LayerFacing, 3> facing;
};

struct PlacedSamples {
  std::vector<VolumeSample> samples;
  GridLayers layers;  // with a voxel for each of them
};

// Such a grid: the values of `grid`, at least two voxels along each axis, with its voxels at `places`. V_k =
// D D^T times `kernel_variance` with D the edges of the voxel's cell, the cell |D|. A cell that has
// collapsed, as at a pole, has no gradient and faces nowhere. Voxels whose values `seen` refuses are left
// out.
PlacedSamples curvilinear_samples(const Volume& grid, double kernel_variance, const VoxelPlaces& places,
                                  const std::function<bool(float)>& seen = {});

// Eq. 37: V with its extent along `normal` (of unit length) divided by s. Flat kernels along the gradient are
// surface splats among volume splats.
glm::dmat3 flattened(const glm::dmat3& variance, const glm::dvec3& normal, double s);

// What a flattened kernel's footprint is multiplied by, seen along a ray at this cosine to its normal. Over a
// layer seen at an angle of tangent t footprints add up to sqrt(1 + t^2) times what they do straight on, as
// the path through it is longer; with this to sqrt(1 + (t/s)^2). So it goes from a layer of volume splats at
// s = 1, where this is 1, to a surface, whose opacity does not grow with its slope, where this is |cosine|. A
// sphere has, in its middle, the same opacity as before it was flattened.
double flattened_weight(double cosine, double s);

}  // namespace splatscope::kernels
