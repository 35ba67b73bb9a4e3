#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "model/number/formats.h"
#include "model/primitive/primitive.h"

// Triangle setup and rasterisation into 2x2 quads.
namespace splatscope::raster {

// origin + dx*x + dy*y, with x and y in pixels from the centre of the setup's origin pixel.
struct Plane {
  float origin = 0, dx = 0, dy = 0;
  float at(float x, float y) const { return origin + (dx * x + dy * y); }
};

// One edge of the triangle: inside where its value >= 0 (a top or left edge contains its own points, the
// others do not). In units of the subpixel grid's step times a pixel, rounded down: that keeps the sign at
// every pixel centre.
struct Edge {
  std::int64_t origin = 0;      // at the origin pixel's centre
  std::int32_t dx = 0, dy = 0;  // change per pixel
};

// A triangle ready to be rasterised. Coverage is decided on the machine's subpixel grid; depth and attributes
// are planes through the unsnapped corners: how the hardware rounds them is not known, and this rounds least.
// A sliver can cover a pixel centre of the grid that lies beside its corners, where the plane of the depth
// says anything: depth stays within that of the corners.
struct TriangleSetup {
  std::array<Edge, 3> edges;
  // Pixels that can be covered: left <= x < right, top <= y < bottom. (left, top) is the origin pixel.
  int left = 0, top = 0, right = 0, bottom = 0;
  Plane depth;                      // window z
  float nearest = 0, furthest = 0;  // of the corners' window z
  Plane weight1, weight2, scale;  // perspective barycentrics of corners 1 and 2: weightN(x, y) / scale(x, y)
  int winding = 0;      // of the corners on the grid: 1 clockwise in the window, -1 the other way, 0 no area
  bool covers = false;  // false: no pixel centre is inside
};

// Direct3D's driver adds half a step of the grid to window coordinates, which makes truncation round to
// nearest.
inline double driver_rounding(int subpixel_bits) {
  return 0.5 / static_cast<double>(1 << subpixel_bits);
}

// Corners of triangles waiting for their setup: structure of arrays, [corner][triangle].
struct Corners {
  static constexpr std::size_t kCapacity = 64;
  alignas(64) double x[3][kCapacity], y[3][kCapacity], z[3][kCapacity], inverse_w[3][kCapacity];

  void set(std::size_t triangle, std::size_t corner, double window_x, double window_y, double window_z,
           double one_over_w) {
    x[corner][triangle] = window_x;
    y[corner][triangle] = window_y;
    z[corner][triangle] = window_z;
    inverse_w[corner][triangle] = one_over_w;
  }
};

struct SetupOptions {
  primitive::Viewport viewport;
  int subpixel_bits = 4;
  double rounding = driver_rounding(4);  // pixels, added to x and y before they are truncated to the grid
  bool interpolates = true;              // false: only the depth is wanted, the other planes stay as they are
};

// Sets up the first out.size() triangles (at most Corners::kCapacity). Coordinates lie within 2 kGuardBand.
void set_up(const Corners& corners, const SetupOptions& options, std::span<TriangleSetup> out);

// The same for triangles 0 1 2 and 0 2 3 of each four vertices, from number `first_vertex` on, in turn: any
// number. Behind the last ones the arrays have room up to a whole number of kQuadVertices.
inline constexpr std::size_t kQuadVertices = 32;
void set_up_quads(const primitive::ProjectedVertices& vertices, std::size_t first_vertex,
                  const SetupOptions& options, std::span<TriangleSetup> out);

// 8x8-pixel tiles that the rectangle of a setup touches. It has the pixels whose centres lie on its right and
// lower side, which the fill rule leaves out: the scan looks at them too.
std::uint32_t tiles_touched(const TriangleSetup& setup);

// 8x8 pixels at even coordinates, a bit each in the order of quads: bit 16*(row of quads) + 4*(column of
// quads) + 2*(y&1) + (x&1).
inline constexpr int kWindow = 8;
struct Window {
  int x = 0, y = 0;  // its first pixel
  std::uint64_t covered = 0;
  std::uint64_t passed = 0;  // subset of `covered` that passed the depth test

  // Of the pixels of a row of four quads.
  static constexpr std::size_t kRowLanes = 16;
  alignas(64) static constexpr std::int32_t kLaneX[kRowLanes] = {0, 1, 0, 1, 2, 3, 2, 3,
                                                                 4, 5, 4, 5, 6, 7, 6, 7};
  alignas(64) static constexpr std::int32_t kLaneY[kRowLanes] = {0, 0, 1, 1, 0, 0, 1, 1,
                                                                 0, 0, 1, 1, 0, 0, 1, 1};
  // Pixels of one row of four quads, 0 to 3.
  static constexpr std::uint32_t row(std::uint64_t pixels, unsigned row) {
    return static_cast<std::uint32_t>(pixels >> kRowLanes * row & 0xffffu);
  }
  static constexpr int x_of(unsigned bit) { return static_cast<int>((bit >> 1 & 6) | (bit & 1)); }
  static constexpr int y_of(unsigned bit) { return static_cast<int>((bit >> 3 & 6) | (bit >> 1 & 1)); }
};

// The depth buffer of a draw.
struct DepthTarget {
  std::span<std::uint32_t> values;  // rows of viewport.width
  primitive::Viewport viewport;
  DepthFormat format = DepthFormat::z24;
  bool test = true;   // passes where depth <= stored depth
  bool write = true;  // of what passed
};

// What became of the pixels of a band.
struct BandCounts {
  std::size_t windows = 0;
  std::uint32_t covered = 0, passed = 0;  // pixels
  std::uint32_t quads = 0;                // with covered pixels
  std::uint32_t quads_passed = 0;         // with pixels that passed
};

// The windows of a triangle with covered pixels in one band of 8 rows, written to `out`; tests (and writes)
// the depth of these pixels. `y`: of the band, even.
inline constexpr std::size_t kMaxWindows = kMostFrameEdge / kWindow + 1;
BandCounts rasterize_band(const TriangleSetup& setup, const DepthTarget& depth, int y,
                          std::span<Window, kMaxWindows> out);

}  // namespace splatscope::raster
