// Triangle setup on SIMD registers of doubles, compiled once a target and chosen at run time (Highway). All
// of the grid's arithmetic is on integers under 2^53, so exact; every target gives the same bits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/raster/simd_setup.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "model/raster/raster.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::raster::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using F = hn::Rebind<float, D>;
using I = hn::Rebind<std::int32_t, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr std::size_t kMaxLanes = 8;

HWY_INLINE V set(double value) {
  return hn::Set(D{}, value);
}

struct Points {
  V x[3], y[3];
};

// The results of one register of triangles, on their way into structures.
struct alignas(64) Lanes {
  double edge_origin[3][kMaxLanes];
  std::int32_t edge_dx[3][kMaxLanes], edge_dy[3][kMaxLanes];
  std::int32_t left[kMaxLanes], top[kMaxLanes], right[kMaxLanes], bottom[kMaxLanes];
  std::int32_t winding[kMaxLanes];
  float planes[4][3][kMaxLanes];
  float nearest[kMaxLanes], furthest[kMaxLanes];
};

HWY_INLINE void store_integers(V value, std::int32_t* to) {
  hn::StoreU(hn::DemoteTo(I{}, value), I{}, to);
}

struct Grid {
  explicit Grid(int subpixel_bits)  // twice as fine, so that pixel centres lie on it for 0 subpixel bits too
      : steps(set(1 << subpixel_bits)),
        pixel(set(2 << subpixel_bits)),
        inverse(set(1.0 / (2 << subpixel_bits))) {}
  // Truncated toward minus infinity, as the NV2A does (tests/oracle/window_geometry.json).
  V snap(V coordinate) const {
    const V below = hn::Floor(hn::Mul(coordinate, steps));
    return hn::Add(below, below);
  }
  // The first pixel whose centre is not left of (above) a coordinate on the grid.
  V first_pixel(V coordinate) const {
    const V half = hn::Mul(pixel, set(0.5));
    return hn::Floor(hn::Mul(hn::Add(coordinate, hn::Sub(half, set(1))), inverse));
  }
  V steps, pixel, inverse;
};

HWY_INLINE void exchange(M mask, V& a, V& b) {
  const V first = hn::IfThenElse(mask, b, a);
  b = hn::IfThenElse(mask, a, b);
  a = first;
}

HWY_INLINE void store_edge(const Grid& grid, V from_x, V from_y, V to_x, V to_y, V centre_x, V centre_y,
                           Lanes& out, std::size_t e) {
  const V dx = hn::Sub(to_x, from_x), dy = hn::Sub(to_y, from_y), zero = hn::Zero(D{});
  const M top_or_left = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
  const V at_centre = hn::Sub(hn::Mul(dx, hn::Sub(centre_y, from_y)), hn::Mul(dy, hn::Sub(centre_x, from_x)));
  const V origin = hn::Sub(at_centre, hn::IfThenZeroElse(top_or_left, set(1)));
  hn::Store(hn::Floor(hn::Mul(origin, grid.inverse)), D{}, out.edge_origin[e]);
  store_integers(hn::Neg(dy), out.edge_dx[e]);
  store_integers(dx, out.edge_dy[e]);
}

// Rectangle, edges and winding.
HWY_INLINE void set_up_coverage(Points p, const Grid& grid, const primitive::Viewport& viewport, Lanes& out) {
  const auto least = [](const V* v) HWY_ATTR { return hn::Min(hn::Min(v[0], v[1]), v[2]); };
  const auto greatest = [](const V* v) HWY_ATTR { return hn::Max(hn::Max(v[0], v[1]), v[2]); };
  const V zero = hn::Zero(D{}), one = set(1);
  const V left = hn::Max(zero, grid.first_pixel(least(p.x)));
  const V top = hn::Max(zero, grid.first_pixel(least(p.y)));
  store_integers(left, out.left);
  store_integers(top, out.top);
  store_integers(hn::Min(set(viewport.width), grid.first_pixel(hn::Add(greatest(p.x), one))), out.right);
  store_integers(hn::Min(set(viewport.height), grid.first_pixel(hn::Add(greatest(p.y), one))), out.bottom);

  // Twice the signed area; positive where the corners run clockwise in the window (y points down).
  const V area = hn::Sub(hn::Mul(hn::Sub(p.x[1], p.x[0]), hn::Sub(p.y[2], p.y[0])),
                         hn::Mul(hn::Sub(p.y[1], p.y[0]), hn::Sub(p.x[2], p.x[0])));
  store_integers(
      hn::Sub(hn::IfThenElseZero(hn::Gt(area, zero), one), hn::IfThenElseZero(hn::Lt(area, zero), one)),
      out.winding);
  exchange(hn::Lt(area, zero), p.x[1], p.x[2]);
  exchange(hn::Lt(area, zero), p.y[1], p.y[2]);
  const V half = hn::Mul(grid.pixel, set(0.5));
  const V centre_x = hn::Add(hn::Mul(left, grid.pixel), half),
          centre_y = hn::Add(hn::Mul(top, grid.pixel), half);
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t next = (e + 1) % 3;
    store_edge(grid, p.x[e], p.y[e], p.x[next], p.y[next], centre_x, centre_y, out, e);
  }
}

// A plane through its values at the corners, by the planes of the barycentrics.
struct Linear {
  V origin, dx, dy;
};
HWY_INLINE void store_plane(V constant, V a1, V a2, const Linear& l1, const Linear& l2,
                            float (&out)[3][kMaxLanes]) {
  const auto put = [](V value, float* to) HWY_ATTR { hn::Store(hn::DemoteTo(F{}, value), F{}, to); };
  put(hn::Add(hn::Add(constant, hn::Mul(a1, l1.origin)), hn::Mul(a2, l2.origin)), out[0]);
  put(hn::Add(hn::Mul(a1, l1.dx), hn::Mul(a2, l2.dx)), out[1]);
  put(hn::Add(hn::Mul(a1, l1.dy), hn::Mul(a2, l2.dy)), out[2]);
}

// `all`: not only that of the depth.
HWY_INLINE void set_up_planes(const Points& p, const V* z, const V* inverse_w, bool all, Lanes& out) {
  const V x1 = hn::Sub(p.x[1], p.x[0]), y1 = hn::Sub(p.y[1], p.y[0]);
  const V x2 = hn::Sub(p.x[2], p.x[0]), y2 = hn::Sub(p.y[2], p.y[0]);
  const V area = hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1));
  const V inverse_area = hn::IfThenZeroElse(hn::Eq(area, hn::Zero(D{})), hn::Div(set(1), area));
  const auto read = [](const std::int32_t* from)
                        HWY_ATTR { return hn::PromoteTo(D{}, hn::LoadU(I{}, from)); };
  const V px = hn::Sub(hn::Add(read(out.left), set(0.5)), p.x[0]);
  const V py = hn::Sub(hn::Add(read(out.top), set(0.5)), p.y[0]);
  const auto linear = [&](V dx, V dy) HWY_ATTR {
    return Linear{hn::Add(hn::Mul(dx, px), hn::Mul(dy, py)), dx, dy};
  };
  const Linear l1 = linear(hn::Mul(y2, inverse_area), hn::Mul(hn::Neg(x2), inverse_area));
  const Linear l2 = linear(hn::Mul(hn::Neg(y1), inverse_area), hn::Mul(x1, inverse_area));
  hn::Store(hn::DemoteTo(F{}, hn::Min(hn::Min(z[0], z[1]), z[2])), F{}, out.nearest);
  hn::Store(hn::DemoteTo(F{}, hn::Max(hn::Max(z[0], z[1]), z[2])), F{}, out.furthest);
  store_plane(z[0], hn::Sub(z[1], z[0]), hn::Sub(z[2], z[0]), l1, l2, out.planes[0]);
  if (!all) return;
  // 1/w relative to its largest keeps the planes in range for any w.
  const V largest = hn::Max(hn::Max(inverse_w[0], inverse_w[1]), inverse_w[2]), zero = hn::Zero(D{});
  const V q0 = hn::Div(inverse_w[0], largest), q1 = hn::Div(inverse_w[1], largest),
          q2 = hn::Div(inverse_w[2], largest);
  store_plane(zero, q1, zero, l1, l2, out.planes[1]);
  store_plane(zero, zero, q2, l1, l2, out.planes[2]);
  store_plane(q0, hn::Sub(q1, q0), hn::Sub(q2, q0), l1, l2, out.planes[3]);
}

HWY_INLINE void read(const Lanes& in, std::size_t lane, bool all, TriangleSetup& out) {
  out.left = in.left[lane];
  out.top = in.top[lane];
  out.right = in.right[lane];
  out.bottom = in.bottom[lane];
  out.winding = in.winding[lane];
  out.covers = out.winding != 0 && out.left < out.right && out.top < out.bottom;
  if (!out.covers) return;
  for (std::size_t e = 0; e < 3; ++e) {
    out.edges[e] = {static_cast<std::int64_t>(in.edge_origin[e][lane]), in.edge_dx[e][lane],
                    in.edge_dy[e][lane]};
  }
  out.nearest = in.nearest[lane];
  out.furthest = in.furthest[lane];
  Plane* planes[] = {&out.depth, &out.weight1, &out.weight2, &out.scale};
  for (std::size_t k = 0; k < (all ? 4 : 1); ++k)
    *planes[k] = {in.planes[k][0][lane], in.planes[k][1][lane], in.planes[k][2][lane]};
}

// A corner of each triangle of a register.
struct Corner {
  V x, y, snapped_x, snapped_y, z, inverse_w;
};

// All triangles alike.
class SetUp {
 public:
  explicit SetUp(const SetupOptions& options)
      : viewport_(options.viewport),
        grid_(options.subpixel_bits),
        rounding_(set(options.rounding)),
        interpolates_(options.interpolates) {}

  Corner corner(V x, V y, V z, V inverse_w) const {
    return {x, y, grid_.snap(hn::Add(x, rounding_)), grid_.snap(hn::Add(y, rounding_)), z, inverse_w};
  }

  // Every `step`th of `out`, at most a register of them.
  void operator()(const Corner& a, const Corner& b, const Corner& c, std::span<TriangleSetup> out,
                  std::size_t step) {
    set_up_coverage({{a.snapped_x, b.snapped_x, c.snapped_x}, {a.snapped_y, b.snapped_y, c.snapped_y}}, grid_,
                    viewport_, lanes_);
    const V z[] = {a.z, b.z, c.z}, inverse_w[] = {a.inverse_w, b.inverse_w, c.inverse_w};
    set_up_planes({{a.x, b.x, c.x}, {a.y, b.y, c.y}}, z, inverse_w, interpolates_, lanes_);
    for (std::size_t lane = 0; lane < hn::Lanes(D{}) && lane * step < out.size(); ++lane)
      read(lanes_, lane, interpolates_, out[lane * step]);
  }

 private:
  const primitive::Viewport& viewport_;
  Grid grid_;
  V rounding_;
  bool interpolates_;
  Lanes lanes_;
};

void set_up(const Corners& in, const SetupOptions& options, std::span<TriangleSetup> out) {
  SetUp set_up(options);
  for (std::size_t first = 0; first < out.size(); first += hn::Lanes(D{})) {
    const auto corner = [&](std::size_t k) HWY_ATTR {
      const auto read = [&](const auto& values) HWY_ATTR { return hn::Load(D{}, values[k] + first); };
      return set_up.corner(read(in.x), read(in.y), read(in.z), read(in.inverse_w));
    };
    set_up(corner(0), corner(1), corner(2), out.subspan(first), 1);
  }
}

// Two corners of a quad are in both of its triangles.
void set_up_quads(const primitive::ProjectedVertices& in, std::size_t first_vertex,
                  const SetupOptions& options, std::span<TriangleSetup> out) {
  SetUp set_up(options);
  for (std::size_t first = 0; first < out.size(); first += 2 * hn::Lanes(D{})) {
    const auto read = [&](const std::vector<double>& values, V* four) HWY_ATTR {
      hn::LoadInterleaved4(D{}, values.data() + first_vertex + 2 * first, four[0], four[1], four[2], four[3]);
    };
    V x[4], y[4], z[4], inverse_w[4];
    read(in.x, x);
    read(in.y, y);
    read(in.z, z);
    read(in.inverse_w, inverse_w);
    Corner corners[4];
    for (std::size_t k = 0; k < 4; ++k) corners[k] = set_up.corner(x[k], y[k], z[k], inverse_w[k]);
    for (std::size_t k = 0; k < 2; ++k)
      set_up(corners[0], corners[1 + k], corners[2 + k], out.subspan(first + k), 2);
  }
}

}  // namespace splatscope::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::raster {
HWY_EXPORT(set_up);
HWY_EXPORT(set_up_quads);

void set_up(const Corners& corners, const SetupOptions& options, std::span<TriangleSetup> out) {
  HWY_DYNAMIC_DISPATCH(set_up)(corners, options, out);
}

void set_up_quads(const primitive::ProjectedVertices& vertices, std::size_t first_vertex,
                  const SetupOptions& options, std::span<TriangleSetup> out) {
  HWY_DYNAMIC_DISPATCH(set_up_quads)(vertices, first_vertex, options, out);
}
}  // namespace splatscope::raster
#endif
