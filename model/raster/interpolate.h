#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/raster/raster.h"

namespace splatscope::raster {

// Of vertices, [attribute][component][vertex]; empty where the draw does not read it.
using VertexAttributes = std::array<std::array<std::vector<float>, 4>, primitive::kAttributes>;

// A piece of a triangle: mostly the triangle itself.
struct Piece {
  const TriangleSetup* setup;
  std::array<std::uint32_t, 3> corners;  // places in the VertexAttributes
};

// Arrays over fragments on their way to the pixel unit have room behind for a whole SIMD register.
inline constexpr std::size_t kFragments = 256, kFragmentStride = kFragments + 16;
using FragmentValues = float[4][kFragmentStride];
using FragmentAttributes = std::array<FragmentValues*, primitive::kAttributes>;  // where each one goes

// Of which piece fragments `first`..`end`-1 are.
struct FragmentsOfPiece {
  Piece piece;
  std::size_t first, end;
};

// Appends the places x + 65536 y in the frame (at most kMostFrameEdge a side) of a window's pixels that
// passed, quad by quad, behind the first `count` of `places`. What lies behind them is overwritten. Returns
// how many there are then, at most kFragments.
std::size_t append_places(const Window& window, std::size_t count,
                          std::span<std::uint32_t, kFragmentStride> places);

// The numbers of the pixels (row-major, `width` in a row) at the first `count` places, and the
// perspective-correct values of the attributes there; `pieces` in the order of their fragments. What lies
// behind is overwritten.
void interpolate(std::span<const FragmentsOfPiece> pieces, std::span<const primitive::UsedAttribute> used,
                 const VertexAttributes& vertices, std::span<const std::uint32_t, kFragmentStride> places,
                 std::size_t count, std::uint32_t width, std::span<std::uint32_t, kFragmentStride> pixels,
                 const FragmentAttributes& out);

}  // namespace splatscope::raster
