#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/raster/raster.h"

namespace splatscope::raster {

using Attributes = std::array<Vec4, primitive::kAttributes>;  // of a vertex

// Fragments on their way to the pixel unit: structure of arrays, with room behind for a whole SIMD register.
struct FragmentPlaces {
  static constexpr std::size_t kCapacity = 256, kStride = kCapacity + 16;
  alignas(64) float x[kStride], y[kStride];  // pixels from their triangle's origin pixel
  alignas(64) std::uint32_t pixel[kStride];  // of the frame, row-major
};
using FragmentValues = float[4][FragmentPlaces::kStride];
using FragmentAttributes = std::array<FragmentValues*, primitive::kAttributes>;  // where each one goes

// Appends the pixels that passed in rows of quads `first_row`..`end_row`-1 (0 to 4) of windows side by side,
// quad by quad through all windows and then row by row, behind the first `count` places. What lies behind
// them is overwritten. Returns how many there are then, at most kCapacity. `width`: of the frame.
std::size_t append_places(const TriangleSetup& setup, std::span<const Window> windows, unsigned first_row,
                          unsigned end_row, std::uint32_t width, std::size_t count, FragmentPlaces& places);

// Perspective-correct values of the attributes for fragments first..end-1, all of one triangle. What lies
// behind `end` is overwritten.
void interpolate(const TriangleSetup& setup, const std::array<const Attributes*, 3>& corners,
                 std::span<const primitive::UsedAttribute> used, const FragmentPlaces& places,
                 std::size_t first, std::size_t end, const FragmentAttributes& out);

}  // namespace splatscope::raster
