#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "kernels/reference/volume/transfer_function.h"
#include "kernels/reference/volume/volume.h"

namespace splatscope::kernels {

// A voxel that is seen, classified before shading and projection (pre-shaded pipeline).
struct VolumeSplat {
  glm::vec3 position{};  // object units
  glm::vec3 normal{};    // of unit length along the gradient, toward larger values; 0 where there is none
  glm::vec3 color{};     // r g b, unshaded
  // Opacity times cell^(2/3), object units squared: over a layer of voxels seen straight on, these times the
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
  std::size_t empty = 0;            // voxels of opacity 0, left out

  int sheet(const VolumeSplat& splat, int axis) const;
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

// The same of samples, in sheets `sheet_spacing` object units apart.
VolumeSplats sample_splats(std::span<const VolumeSample> samples, const TransferFunction& transfer,
                           double sheet_spacing, const Flattening& flattening = {});

// The sheets along one axis: the numbers of their splats, and where each sheet begins among them.
struct SheetOrder {
  std::vector<std::uint32_t> splats;  // by sheet, within it as they stand
  std::vector<std::uint32_t> first;   // of each sheet, and the end
};
SheetOrder sheet_order(const VolumeSplats& splats, int axis);

}  // namespace splatscope::kernels
