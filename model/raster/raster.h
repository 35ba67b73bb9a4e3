#pragma once

#include <array>
#include <cstdint>

#include "model/primitive/primitive.h"

// Triangle setup and rasterisation into 2x2 quads.
namespace splatscope::raster {

// origin + dx*x + dy*y, with x and y in pixels from the centre of the setup's origin pixel.
struct Plane {
  float origin = 0, dx = 0, dy = 0;
  float at(float x, float y) const { return origin + (dx * x + dy * y); }
};

// One edge of the triangle on the subpixel grid: inside where its value >= 0 (a top or left edge contains its
// own points, the others do not: that is folded into `origin`).
struct Edge {
  std::int64_t origin = 0, dx = 0, dy = 0;  // at the origin pixel's centre; change per pixel
};

// A triangle ready to be rasterised. Coverage is decided on the machine's subpixel grid; depth and attributes
// are planes through the unsnapped corners: how the hardware rounds them is not known, and this rounds least.
struct TriangleSetup {
  std::array<Edge, 3> edges;
  int left = 0, top = 0, right = 0,
      bottom = 0;                 // pixels that can be covered: left <= x < right, top <= y < bottom
  Plane depth;                    // window z
  Plane weight1, weight2, scale;  // perspective barycentrics of corners 1 and 2: weightN(x, y) / scale(x, y)
  bool covers = false;            // false: no pixel centre is inside
};

// A window coordinate on the subpixel grid, in units of 2^-(bits+1) pixel: truncated toward minus infinity,
// as the NV2A does (tests/oracle/window_geometry.json).
std::int64_t snap(double coordinate, int subpixel_bits);

// Direct3D's driver adds half a step of the grid to window coordinates, which makes truncation round to
// nearest.
inline double driver_rounding(int subpixel_bits) {
  return 0.5 / static_cast<double>(1 << subpixel_bits);
}

// `rounding` (pixels) is added to x and y before they are truncated.
TriangleSetup set_up(const primitive::WindowTriangle& triangle, const primitive::Viewport& viewport,
                     int subpixel_bits, double rounding);

// Which way round the corners run in the window on the subpixel grid: positive clockwise, negative
// counter-clockwise, 0 without area.
int winding(const primitive::WindowTriangle& triangle, int subpixel_bits, double rounding);

// 8x8-pixel tiles that the rectangle of a setup touches.
std::uint32_t tiles_touched(const TriangleSetup& setup);

// Calls visit(x, y, mask) for every 2x2 quad with coverage, row by row: x and y are the even coordinates of
// its first pixel, mask has bit (y&1)*2 + (x&1). Pixels outside the viewport are never covered.
template <typename Visit>
void for_each_quad(const TriangleSetup& setup, Visit&& visit) {
  if (!setup.covers) return;
  const int first_x = setup.left & ~1, first_y = setup.top & ~1;
  std::int64_t row[3];
  for (int e = 0; e < 3; ++e) {
    const Edge& edge = setup.edges[e];
    row[e] = edge.origin + edge.dx * (first_x - setup.left) + edge.dy * (first_y - setup.top);
  }
  for (int y = first_y; y < setup.bottom; y += 2) {
    std::int64_t value[3] = {row[0], row[1], row[2]};
    const unsigned rows = (y >= setup.top ? 0x3u : 0u) | (y + 1 < setup.bottom ? 0xcu : 0u);
    for (int x = first_x; x < setup.right; x += 2) {
      std::int64_t inside[4] = {0, 0, 0, 0};  // negative: outside one of the edges
      for (int e = 0; e < 3; ++e) {
        const std::int64_t v = value[e], dx = setup.edges[e].dx, dy = setup.edges[e].dy;
        inside[0] |= v;
        inside[1] |= v + dx;
        inside[2] |= v + dy;
        inside[3] |= v + dx + dy;
        value[e] = v + 2 * dx;
      }
      const unsigned columns = (x >= setup.left ? 0x5u : 0u) | (x + 1 < setup.right ? 0xau : 0u);
      unsigned mask = rows & columns;
      for (unsigned pixel = 0; pixel < 4; ++pixel)
        mask &= ~(static_cast<unsigned>(inside[pixel] < 0) << pixel);
      if (mask != 0) visit(x, y, mask);
    }
    for (int e = 0; e < 3; ++e) row[e] += 2 * setup.edges[e].dy;
  }
}

}  // namespace splatscope::raster
