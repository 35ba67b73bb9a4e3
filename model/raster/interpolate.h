#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/raster/raster.h"

namespace splatscope::raster {

using Attributes = std::array<Vec4, primitive::kAttributes>;  // of a vertex

// Fragments on their way to the pixel unit: structure of arrays, with room behind for a whole SIMD register.
struct FragmentPlaces {
  static constexpr std::size_t kCapacity = 64, kStride = kCapacity + 16;
  alignas(64) float x[kStride], y[kStride];  // pixels from their triangle's origin pixel
};
struct FragmentAttributes {
  alignas(64) float values[primitive::kAttributes][4][FragmentPlaces::kStride];
};

// Perspective-correct values of the attributes for fragments first..end-1, all of one triangle. What lies
// behind `end` is overwritten.
void interpolate(const TriangleSetup& setup, const std::array<const Attributes*, 3>& corners,
                 std::span<const primitive::UsedAttribute> used, const FragmentPlaces& places,
                 std::size_t first, std::size_t end, FragmentAttributes& out);

}  // namespace splatscope::raster
