#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/reference/row_bands.h"
#include "kernels/view.h"

// The inside of fast_splatting: its data, and what is done to them on SIMD registers.
namespace splatscope::kernels {

// Surfels as structure of arrays, one array a component: see kernels::Surfel. Padded by surfels of size 0 to
// whole SIMD registers.
struct FastSurfels {
  enum Component { x, y, z, sx, sy, sz, tx, ty, tz, sigma, weight, red, green, blue, kComponents };
  static constexpr std::size_t kPadding = 8;  // lanes: the widest that is used
  std::array<std::vector<float>, kComponents> values;
};

// A view in single precision.
struct FastCamera {
  explicit FastCamera(const View& view);
  float rows[3][4];  // object to camera
  float eta, center_x, center_y, near_plane, far_plane;
  float width, height;
};

// With the settings.
struct FastView : FastCamera {
  using FastCamera::FastCamera;
  float low_pass = 0;  // variance of the low-pass filter, pixels: 1, or 0 without
  float reach = 0;     // sqrt(2c)
  bool cull_back_faces = false;
};

struct FastBox {
  std::int32_t left, top, right, bottom;  // right and bottom excluded, within the picture
};

// A splat as one view sees it. Functions of a pixel's centre are in its distance dx, dy from x_k.
struct FastSplat {
  float x, y;                        // x_k, pixels
  float w, w_dx, w_dy;               // 1/z of the tangent plane under the ray: linear on the screen
  float u0_dx, u0_dy, u1_dx, u1_dy;  // u/z: the opaque quad is where both are at most 1/z
  float xx, xy, yy;                  // Q = xx dx^2 + xy dx dy + yy dy^2 = y.y (Zwicker 2002, section 7.1)
  float color[4];                    // s_k rho_k(x_k) times (w_k, 1)
  FastBox quad, ellipse;
};

// exp(-Q/2) over [0, 2c]: the value in the middle of each of its steps, which are off by at most c/2048 of
// it.
struct FastTable {
  static constexpr int kSteps = 1024;
  std::array<float, kSteps + 1> values;  // the last for Q = 2c itself
  float limit;                           // 2c
  float scale;                           // steps a unit of Q
  explicit FastTable(double cutoff);
};

// The rows of a band, `stride` floats each, with room for a SIMD register beyond the picture.
struct FastBand {
  RowRange rows;
  std::size_t stride;
  std::vector<float> nearest;              // 1/z of the nearest opaque quad, 0 where there is none; then the
                                           // smallest 1/z that still counts
  std::array<std::vector<float>, 4> sums;  // r g b and weight
};

// Surfels from `begin` (a multiple of the padding) to `end`: writes those that can be seen to `splats`, in
// order, and their rows to `rows`. Returns how many.
std::size_t prepare_splats(const FastSurfels& surfels, const FastView& view, std::size_t begin,
                           std::size_t end, FastSplat* splats, RowRange* rows);

// Draws the opaque quad into `nearest`; both count up to `nearest_w` = 1/near only.
void draw_quads(std::span<const FastSplat> splats, std::span<const std::uint32_t> order, float nearest_w,
                FastBand& band);

// Adds the splats where they are no further than `nearest` says.
void add_splats(std::span<const FastSplat> splats, std::span<const std::uint32_t> order, float nearest_w,
                const FastTable& table, FastBand& band);

}  // namespace splatscope::kernels
