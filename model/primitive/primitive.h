#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/work/work.h"

// Primitive assembly: from shaded vertices in clip space to triangles in window coordinates.
namespace splatscope::primitive {

// What the pixel unit reads of a vertex, in this order; only those that a draw uses are interpolated.
enum Attribute : int { kDiffuse = 0, kSpecular = 1, kTexcoord0 = 2, kAttributes = 6 };

struct Viewport {
  std::uint32_t width = 0, height = 0;
};

// Which components of an attribute a draw interpolates: the first `components`.
struct UsedAttribute {
  int attribute = 0;
  int components = 4;
};

struct ClipVertex {
  Vec4 position{};  // x y z w of oPos; the clip volume is -w <= x, y <= w, 0 <= z <= w (Direct3D)
  std::array<Vec4, kAttributes> attributes{};
};

// Direct3D 8 puts pixel centres at integer window coordinates, the rasteriser at halves.
inline constexpr double kPixelCentre = 0.5;

struct WindowVertex {
  double x = 0, y = 0;  // pixels from the left and top edge; the centre of pixel i is at i + 0.5
  double z = 0;         // 0 (near) to 1 (far)
  double inverse_w = 0;
  std::array<Vec4, kAttributes> attributes{};
};

// Pixels each way: beyond it a triangle is clipped, inside it the scissor of the rasteriser is enough, as on
// the hardware of 2002 (the width of its guard band is not published: this one is ours). Rounding can put
// what was clipped further out, but never beyond twice of it.
inline constexpr double kGuardBand = 32768.0;

// Vertices of one triangle list after the vertex program: structure of arrays.
struct ProjectedVertices {
  std::vector<double> x, y, z, inverse_w;  // as WindowVertex; of vertices that are `plain`
  std::vector<std::int32_t> outside;       // bit n: outside side n of the frustum; kNotPlain: see below
};

// A vertex that is not finite, or before the near plane, behind the eye, beyond the far plane or the guard
// band: a triangle of such a one goes through assemble().
inline constexpr std::int32_t kNotPlain = 1u << 4;

// Projects `count` vertices from clip space, [component][vertex], to the places from `first` of `out`. The
// arrays have room for a whole number of kProjectionLanes.
inline constexpr std::size_t kProjectionLanes = 8;
void project(const std::array<const float*, 4>& position, std::size_t count, const Viewport& viewport,
             ProjectedVertices& out, std::size_t first);

using ClipTriangle = std::array<ClipVertex, 3>;
using WindowTriangle = std::array<WindowVertex, 3>;

// A triangle clipped by seven planes has at most this many corners.
inline constexpr int kMaxCorners = 10;
inline constexpr int kMaxPieces = kMaxCorners - 2;

struct Assembled {
  TriangleOutcome outcome = TriangleOutcome::drawn;  // `drawn` where pieces are left to rasterise
  int pieces = 0;
};

// Rejects, clips and projects one triangle; writes its pieces (a fan) to `out`. Only the attributes in `used`
// (indices into Attribute) are carried along.
Assembled assemble(const ClipTriangle& triangle, const Viewport& viewport,
                   std::span<const UsedAttribute> used, std::array<WindowTriangle, kMaxPieces>& out);

}  // namespace splatscope::primitive
