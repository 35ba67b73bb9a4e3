#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "kernels/reference/volume/transfer_function.h"
#include "kernels/reference/volume/volume.h"
#include "kernels/view.h"

namespace splatscope::kernels {

// A voxel that is seen, classified before shading and projection (pre-shaded pipeline).
struct VolumeSplat {
  glm::vec3 position{};  // object units
  glm::vec3 normal{};    // of unit length along the gradient, toward larger values; 0 where there is none
  glm::vec3 color{};     // r g b, unshaded
  // Opacity times cell^(2/3), object units squared: over a layer of cubes seen straight on, these times the
  // kernels of unit integral add up to the opacity.
  float weight = 0;
  float flatness = 0;        // 1 - 1/s of Eq. 37, along the normal: 0 for a volume splat
  std::uint32_t kernel = 0;  // its variance matrix in VolumeSplats::kernels
};

struct VolumeSplats {
  std::vector<VolumeSplat> splats;
  std::vector<glm::dmat3> kernels;  // V_k, object units squared; a grid's have one
  glm::dvec3 low{};                 // object units, of the first sheet along each axis
  glm::dvec3 sheet_spacing{1.0};    // between sheets, along each axis
  GridLayers layers;                // of a rectilinear or curvilinear grid, a voxel for each splat; else none
  std::size_t empty = 0;            // voxels of opacity 0, left out

  // `axis` as in SheetAxis.
  int sheet(std::size_t splat, int axis) const;
};

// Which voxels are drawn as flat kernels, surface splats (section 6.4).
struct Flattening {
  double low = 1, high = 0;            // of their values, both included; none where low > high
  double s = 1e4;                      // Eq. 37
  std::optional<glm::dvec3> normal{};  // of unit length; else along each voxel's gradient
};

// The voxels of a grid whose opacity is above 0. V = kernel_variance diag(spacing^2).
VolumeSplats grid_splats(const Volume& volume, const TransferFunction& transfer, double kernel_variance = 1,
                         const Flattening& flattening = {});

// The same of samples, in sheets `sheet_spacing` object units apart; `layers`, of samples on a grid, has a
// voxel for each.
VolumeSplats sample_splats(std::span<const VolumeSample> samples, const TransferFunction& transfer,
                           double sheet_spacing, const Flattening& flattening = {},
                           const GridLayers& layers = {});

// The axis of the sheets, and whether the last of them is the nearest. 0 to 2: across x, y or z of object
// space, as far apart as `sheet_spacing`; from kLayerAxes on the layers along an axis of the grid.
struct SheetAxis {
  int axis = 0;
  bool last_is_nearest = false;
};
inline constexpr int kLayerAxes = 3, kSheetAxes = 6;

// `given`, or the axis most parallel to the line of sight: of the grid where it has layers of its own and
// they all face the eye from one side, else of object space.
SheetAxis sheet_axis(const View& view, const VolumeSplats& splats, std::optional<int> given);

// The sheets along one axis: the numbers of their splats, and where each sheet begins among them.
struct SheetOrder {
  std::vector<std::uint32_t> splats;  // by sheet, within it as they stand
  std::vector<std::uint32_t> first;   // of each sheet, and the end
};
SheetOrder sheet_order(const VolumeSplats& splats, int axis);

}  // namespace splatscope::kernels
