#include "model/raster/raster.h"

#include <algorithm>
#include <cmath>

namespace splatscope::raster {
namespace {

struct Point {
  std::int64_t x, y;
};

// Twice the signed area; positive where the corners run clockwise on the screen (y points down).
std::int64_t doubled_area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

Edge make_edge(const Point& from, const Point& to, const Point& centre, std::int64_t pixel) {
  const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
  const bool top_or_left = dy < 0 || (dy == 0 && dx > 0);
  return {.origin = dx * (centre.y - from.y) - dy * (centre.x - from.x) - (top_or_left ? 0 : 1),
          .dx = -dy * pixel,
          .dy = dx * pixel};
}

// The first pixel whose centre is not left of (above) a coordinate on the grid of `1 << shift` steps a pixel.
int first_pixel(std::int64_t coordinate, int shift) {
  const std::int64_t pixel = std::int64_t{1} << shift;
  return static_cast<int>((coordinate + pixel / 2 - 1) >> shift);
}

std::array<Point, 3> snap_corners(const primitive::WindowTriangle& triangle, int subpixel_bits,
                                  double rounding) {
  std::array<Point, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = {snap(triangle[i].x + rounding, subpixel_bits),
                  snap(triangle[i].y + rounding, subpixel_bits)};
  }
  return corners;
}

void set_up_planes(const primitive::WindowTriangle& triangle, TriangleSetup& setup) {
  const auto& [v0, v1, v2] = triangle;
  const double x1 = v1.x - v0.x, y1 = v1.y - v0.y, x2 = v2.x - v0.x, y2 = v2.y - v0.y;
  const double area = x1 * y2 - x2 * y1;
  const double inverse_area = area != 0 ? 1.0 / area : 0.0;
  const double px = setup.left + 0.5 - v0.x, py = setup.top + 0.5 - v0.y;

  struct Linear {
    double origin, dx, dy;
  };
  const auto linear = [&](double dx, double dy) { return Linear{dx * px + dy * py, dx, dy}; };
  const Linear l1 = linear(y2 * inverse_area, -x2 * inverse_area);
  const Linear l2 = linear(-y1 * inverse_area, x1 * inverse_area);
  const auto combine = [&](double constant, double a1, double a2) {
    return Plane{static_cast<float>(constant + a1 * l1.origin + a2 * l2.origin),
                 static_cast<float>(a1 * l1.dx + a2 * l2.dx), static_cast<float>(a1 * l1.dy + a2 * l2.dy)};
  };
  setup.depth = combine(v0.z, v1.z - v0.z, v2.z - v0.z);
  // 1/w relative to its largest keeps the planes in range for any w.
  const double largest = std::max({v0.inverse_w, v1.inverse_w, v2.inverse_w});
  const double q0 = v0.inverse_w / largest, q1 = v1.inverse_w / largest, q2 = v2.inverse_w / largest;
  setup.weight1 = combine(0, q1, 0);
  setup.weight2 = combine(0, 0, q2);
  setup.scale = combine(q0, q1 - q0, q2 - q0);
}

}  // namespace

std::int64_t snap(double coordinate, int subpixel_bits) {
  return 2 * static_cast<std::int64_t>(std::floor(coordinate * static_cast<double>(1 << subpixel_bits)));
}

TriangleSetup set_up(const primitive::WindowTriangle& triangle, const primitive::Viewport& viewport,
                     int subpixel_bits, double rounding) {
  TriangleSetup setup;
  // Twice the grid, so that pixel centres lie on it for 0 subpixel bits too.
  const int shift = subpixel_bits + 1;
  std::array<Point, 3> p = snap_corners(triangle, subpixel_bits, rounding);
  const std::int64_t area = doubled_area(p[0], p[1], p[2]);
  if (area == 0) return setup;

  setup.left = std::max(0, first_pixel(std::min({p[0].x, p[1].x, p[2].x}), shift));
  setup.top = std::max(0, first_pixel(std::min({p[0].y, p[1].y, p[2].y}), shift));
  setup.right =
      std::min(static_cast<int>(viewport.width), first_pixel(std::max({p[0].x, p[1].x, p[2].x}) + 1, shift));
  setup.bottom =
      std::min(static_cast<int>(viewport.height), first_pixel(std::max({p[0].y, p[1].y, p[2].y}) + 1, shift));
  if (setup.left >= setup.right || setup.top >= setup.bottom) return setup;

  if (area < 0) std::swap(p[1], p[2]);
  const std::int64_t pixel = std::int64_t{1} << shift;
  const Point centre{setup.left * pixel + pixel / 2, setup.top * pixel + pixel / 2};
  for (std::size_t i = 0; i < 3; ++i) setup.edges[i] = make_edge(p[i], p[(i + 1) % 3], centre, pixel);
  set_up_planes(triangle, setup);
  setup.covers = true;
  return setup;
}

int winding(const primitive::WindowTriangle& triangle, int subpixel_bits, double rounding) {
  const auto [a, b, c] = snap_corners(triangle, subpixel_bits, rounding);
  const std::int64_t area = doubled_area(a, b, c);
  return (area > 0) - (area < 0);
}

std::uint32_t tiles_touched(const TriangleSetup& setup) {
  if (!setup.covers) return 0;
  const int columns = ((setup.right - 1) >> 3) - (setup.left >> 3) + 1;
  const int rows = ((setup.bottom - 1) >> 3) - (setup.top >> 3) + 1;
  return static_cast<std::uint32_t>(columns) * static_cast<std::uint32_t>(rows);
}

}  // namespace splatscope::raster
