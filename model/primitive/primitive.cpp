#include "model/primitive/primitive.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatscope::primitive {
namespace {

struct Polygon {
  std::array<ClipVertex, kMaxCorners> corners;
  int count = 0;
};

bool finite(const ClipVertex& vertex) {
  for (const float value : vertex.position) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

// Signed distance to a clip plane, positive inside, in double so that no finite position overflows.
struct Plane {
  double x, y, z, w, offset;
  double distance(const Vec4& p) const { return x * p[0] + y * p[1] + z * p[2] + w * p[3] - offset; }
};

constexpr Plane kNear{0, 0, 1, 0, 0};
constexpr Plane kFar{0, 0, -1, 1, 0};
constexpr Plane kSides[] = {{1, 0, 0, 1, 0}, {-1, 0, 0, 1, 0}, {0, 1, 0, 1, 0}, {0, -1, 0, 1, 0}};
// A program that is no projection can have z inside and w not: nothing is divided by less than this.
constexpr Plane kPositiveW{0, 0, 0, 1, std::numeric_limits<float>::min()};

int count_outside(const ClipTriangle& triangle, const Plane& plane) {
  int outside = 0;
  for (const ClipVertex& vertex : triangle) outside += plane.distance(vertex.position) < 0;
  return outside;
}

ClipVertex between(const ClipVertex& a, const ClipVertex& b, double t, std::span<const UsedAttribute> used) {
  const auto mix = [t](float from, float to) { return static_cast<float>(from + t * (double{to} - from)); };
  ClipVertex out;
  for (int c = 0; c < 4; ++c) out.position[c] = mix(a.position[c], b.position[c]);
  for (const auto& [i, components] : used) {
    for (int c = 0; c < 4; ++c) out.attributes[i][c] = mix(a.attributes[i][c], b.attributes[i][c]);
  }
  return out;
}

// Sutherland and Hodgman's step: the part of a convex polygon inside one plane.
Polygon clip(const Polygon& in, const Plane& plane, std::span<const UsedAttribute> used) {
  Polygon out;
  for (int i = 0; i < in.count && out.count < kMaxCorners; ++i) {
    const ClipVertex& a = in.corners[i];
    const ClipVertex& b = in.corners[(i + 1) % in.count];
    const double da = plane.distance(a.position), db = plane.distance(b.position);
    if (da >= 0) out.corners[out.count++] = a;
    if ((da < 0) != (db < 0) && out.count < kMaxCorners) {
      // Always from the inner to the outer corner, so that neighbours sharing an edge get the same point.
      out.corners[out.count++] =
          da >= 0 ? between(a, b, da / (da - db), used) : between(b, a, db / (db - da), used);
    }
  }
  return out;
}

// A cut point lies on its plane but for rounding, which is of the size of the corners and is divided by a w
// that can be near 0: what that moves out of the clip volume is moved back.
WindowVertex project(const ClipVertex& vertex, const Viewport& viewport) {
  const double inverse_w = 1.0 / std::max(double{vertex.position[3]}, kPositiveW.offset);
  const auto in_band = [](double pixels) { return std::clamp(pixels, -2 * kGuardBand, 2 * kGuardBand); };
  WindowVertex out;
  out.x = in_band((1.0 + vertex.position[0] * inverse_w) * 0.5 * viewport.width + kPixelCentre);
  out.y = in_band((1.0 - vertex.position[1] * inverse_w) * 0.5 * viewport.height + kPixelCentre);
  out.z = std::clamp(vertex.position[2] * inverse_w, 0.0, 1.0);
  out.inverse_w = inverse_w;
  out.attributes = vertex.attributes;
  return out;
}

}  // namespace

Assembled assemble(const ClipTriangle& triangle, const Viewport& viewport,
                   std::span<const UsedAttribute> used, std::array<WindowTriangle, kMaxPieces>& out) {
  for (const ClipVertex& vertex : triangle) {
    if (!finite(vertex)) return {TriangleOutcome::not_finite, 0};
  }
  if (count_outside(triangle, kNear) == 3 || count_outside(triangle, kPositiveW) == 3) {
    return {TriangleOutcome::behind_near, 0};
  }
  if (count_outside(triangle, kFar) == 3) return {TriangleOutcome::outside_frustum, 0};
  for (const Plane& plane : kSides) {
    if (count_outside(triangle, plane) == 3) return {TriangleOutcome::outside_frustum, 0};
  }

  const double guard_x = 2 * kGuardBand / viewport.width - 1, guard_y = 2 * kGuardBand / viewport.height - 1;
  const Plane planes[] = {kNear,
                          kPositiveW,
                          kFar,
                          {1, 0, 0, guard_x, 0},
                          {-1, 0, 0, guard_x, 0},
                          {0, 1, 0, guard_y, 0},
                          {0, -1, 0, guard_y, 0}};
  const auto cuts = [&](const Plane& plane) { return count_outside(triangle, plane) > 0; };
  if (std::ranges::none_of(planes, cuts)) {  // nearly every triangle
    for (std::size_t i = 0; i < 3; ++i) out[0][i] = project(triangle[i], viewport);
    return {TriangleOutcome::drawn, 1};
  }
  Polygon polygon{{triangle[0], triangle[1], triangle[2]}, 3};
  for (const Plane& plane : planes) {
    if (cuts(plane)) polygon = clip(polygon, plane, used);
  }
  if (polygon.count < 3) return {TriangleOutcome::outside_frustum, 0};

  const WindowVertex first = project(polygon.corners[0], viewport);
  WindowVertex previous = project(polygon.corners[1], viewport);
  for (int i = 2; i < polygon.count; ++i) {
    const WindowVertex next = project(polygon.corners[i], viewport);
    out[i - 2] = {first, previous, next};
    previous = next;
  }
  return {TriangleOutcome::drawn, polygon.count - 2};
}

}  // namespace splatscope::primitive
