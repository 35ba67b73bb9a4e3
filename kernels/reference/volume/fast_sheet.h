#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/reference/fast_splat.h"
#include "kernels/reference/volume/footprint.h"
#include "kernels/reference/volume/volume_splats.h"

// The inside of fast_volume: its data, and what is done to them on SIMD registers.
namespace splatscope::kernels {

// xx, xy, xz, yy, yz, zz of a variance matrix, and of its adjugate: in single precision that would lose the
// least variance of a long kernel.
inline constexpr std::size_t kVarianceTerms = 12;
using FastVariance = std::array<float, kVarianceTerms>;

enum class FastKernels : std::uint8_t {
  spherical,  // sigma^2 I, none of them flat
  shared,     // one variance matrix, in camera space
  own         // one a splat, in object space
};

// specular * cos^shininess by the cosine, straight between 1024 steps.
struct SpecularTable {
  static constexpr int kSteps = 1024;
  std::array<float, kSteps + 2> values;
  SpecularTable(double specular, double shininess);
};

// View and settings in single precision.
struct FastVolumeView : FastCamera {
  using FastCamera::FastCamera;
  float normal_scale = 0;  // 1/scale of the view: normals stay of unit length
  bool perspective = false;
  VolumePrefilter prefilter{};
  FastKernels kernels{};
  FastVariance variance{};  // camera space; not where each has its own
  float opacity_scale = 0;  // of weight |J| / sqrt |V|
  float reach = 0;          // sqrt(cutoff)
  float ambient = 0, diffuse = 0;
  float toward_light[3]{};
};

// A splat as one view sees it.
struct SheetSplat {
  float x, y;        // x_k, pixels
  float xx, xy, yy;  // r = xx dx^2 + xy dx dy + yy dy^2
  float color[4];    // r g b times opacity, and opacity, at the centre
  FastBox box;
  std::uint32_t sheet;
};

// The rows of a band, `stride` floats each, with room for a SIMD register beyond the picture.
struct SheetBand {
  RowRange rows;
  std::size_t stride = 0;
  FastBox dirty{};                            // what the sheet's splats have touched
  std::array<std::vector<float>, 4> sheet;    // r g b times opacity, and opacity
  std::array<std::vector<float>, 4> picture;  // the same, of all sheets behind it
};

// Projects the splats of these numbers; writes those that can be seen to `out`, in order, and their rows.
// Returns how many. `kernels` are in object space, for FastKernels::own.
std::size_t project_splats(const FastVolumeView& view, const SpecularTable& specular,
                           std::span<const VolumeSplat> splats, std::span<const FastVariance> kernels,
                           std::span<const std::uint32_t> numbers, std::span<const std::uint32_t> sheets,
                           SheetSplat* out, RowRange* rows);

void add_to_sheet(std::span<const SheetSplat> splats, std::span<const std::uint32_t> order,
                  const FastTable& table, SheetBand& band);

// Puts the sheet over the picture and clears it.
void composite_sheet(SheetBand& band);

}  // namespace splatscope::kernels
