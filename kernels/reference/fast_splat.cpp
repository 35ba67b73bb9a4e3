// The loops of fast_splatting on SIMD registers, compiled once a target and chosen at run time (Highway).
// Lanes never depend on one another and nothing is fused: every target gives the same bits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/reference/fast_splat.cpp"
#include "kernels/reference/fast_splat.h"

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numbers>

#include "kernels/reference/simd_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::kernels::HWY_NAMESPACE {

constexpr std::size_t kSplatValues = offsetof(FastSplat, quad) / sizeof(float);

// Boxes of the pixels whose centres lie between low and high, a lane each.
struct Boxes {
  HWY_ALIGN std::int32_t left[FastSurfels::kPadding], top[FastSurfels::kPadding],
      right[FastSurfels::kPadding], bottom[FastSurfels::kPadding];

  HWY_INLINE void set_columns(const FastView& view, V low, V high) {
    store_span(low, high, view.width, left, right);
  }
  HWY_INLINE void set_rows(const FastView& view, V low, V high) {
    store_span(low, high, view.height, top, bottom);
  }
  FastBox operator[](std::size_t lane) const { return {left[lane], top[lane], right[lane], bottom[lane]}; }
};

// What becomes of one register of surfels; a lane's values are stored only where it is kept.
struct Batch {
  HWY_ALIGN float values[kSplatValues][FastSurfels::kPadding];  // in the order of FastSplat's floats
  Boxes quad, ellipse;
  M keep;
};

// Window coordinates of the corners of o +- s +- t, or everything where one is not beyond the near plane.
HWY_INLINE void quad_box(const FastView& view, const V3& o, const V3& s, const V3& t, Boxes& boxes) {
  const V eta = set(view.eta), infinite = set(1e9f);
  V low_x = infinite, low_y = infinite, high_x = hn::Neg(infinite), high_y = high_x;
  for (int corner = 0; corner < 4; ++corner) {
    const auto along = [&](V a, V b, V c) HWY_ATTR {
      const V first = corner & 1 ? hn::Add(a, b) : hn::Sub(a, b);
      return corner & 2 ? hn::Add(first, c) : hn::Sub(first, c);
    };
    const V scale = hn::Div(eta, along(o.z, s.z, t.z));
    const V x = hn::Add(set(view.center_x), hn::Mul(scale, along(o.x, s.x, t.x)));
    const V y = hn::Sub(set(view.center_y), hn::Mul(scale, along(o.y, s.y, t.y)));
    low_x = hn::Min(low_x, x);
    high_x = hn::Max(high_x, x);
    low_y = hn::Min(low_y, y);
    high_y = hn::Max(high_y, y);
  }
  const V nearest = hn::Sub(o.z, hn::Add(hn::Abs(s.z), hn::Abs(t.z)));
  const M beyond = hn::Gt(nearest, set(view.near_plane));
  boxes.set_columns(view, hn::IfThenElse(beyond, low_x, hn::Neg(infinite)),
                    hn::IfThenElse(beyond, high_x, infinite));
  boxes.set_rows(view, hn::IfThenElse(beyond, low_y, hn::Neg(infinite)),
                 hn::IfThenElse(beyond, high_y, infinite));
}

// The filter of a surfel on the screen.
struct Filter {
  V vxx, vxy, vyy;  // variance
  V inverse;        // of its determinant
  V height;
};

// Jacobian (Ren 2002, section 5.2), V = sigma^2 J J^T + I, and |V| in positive terms. `plane` is n.o.
HWY_INLINE Filter filter_of(const FastView& view, const V3& o, const V3& s, const V3& t, V inverse_z, V plane,
                            V sigma, V weight) {
  const V scale = hn::Mul(set(view.eta), square(inverse_z));
  const auto jacobian_x = [&](const V3& a) HWY_ATTR {
    return hn::Mul(scale, hn::Sub(hn::Mul(a.x, o.z), hn::Mul(a.z, o.x)));
  };
  const auto jacobian_y = [&](const V3& a) HWY_ATTR {
    return hn::Mul(scale, hn::Sub(hn::Mul(a.z, o.y), hn::Mul(a.y, o.z)));
  };
  const V jsx = jacobian_x(s), jsy = jacobian_y(s), jtx = jacobian_x(t), jty = jacobian_y(t);
  const V sigma2 = square(sigma), low_pass = set(view.low_pass);
  const V jjxx = hn::Add(square(jsx), square(jtx)), jjyy = hn::Add(square(jsy), square(jty));
  const V determinant_j = hn::Abs(hn::Mul(hn::Mul(square(set(view.eta)), plane),  // of J: eta^2 n.o / o_z^3
                                          hn::Mul(square(inverse_z), inverse_z)));
  const V spread = hn::Add(hn::Mul(sigma2, hn::Add(jjxx, jjyy)), low_pass);
  const V determinant = hn::Add(square(hn::Mul(sigma2, determinant_j)), hn::Mul(low_pass, spread));
  return {.vxx = hn::Add(hn::Mul(sigma2, jjxx), low_pass),
          .vxy = hn::Mul(sigma2, hn::Add(hn::Mul(jsx, jsy), hn::Mul(jtx, jty))),
          .vyy = hn::Add(hn::Mul(sigma2, jjyy), low_pass),
          .inverse = hn::Div(set(1.0f), determinant),
          .height = hn::Mul(hn::Mul(weight, set(0.5f * std::numbers::inv_pi_v<float>)),
                            hn::Div(determinant_j, hn::Sqrt(determinant)))};
}

// False where no lane is kept.
HWY_INLINE bool prepare_batch(const FastSurfels& surfels, const FastView& view, std::size_t i, Batch& batch) {
  const auto load = [&](FastSurfels::Component c)
                        HWY_ATTR { return hn::LoadU(F{}, surfels.values[c].data() + i); };
  const auto direction = [&](FastSurfels::Component x, FastSurfels::Component y, FastSurfels::Component z)
                             HWY_ATTR {
                               return turned(view, {load(x), load(y), load(z)});
                             };
  const V3 moved = direction(FastSurfels::x, FastSurfels::y, FastSurfels::z);
  const V3 o{hn::Add(moved.x, set(view.rows[0][3])), hn::Add(moved.y, set(view.rows[1][3])),
             hn::Add(moved.z, set(view.rows[2][3]))};
  const V3 s = direction(FastSurfels::sx, FastSurfels::sy, FastSurfels::sz);
  const V3 t = direction(FastSurfels::tx, FastSurfels::ty, FastSurfels::tz);
  const V3 normal = cross(s, t);
  const V plane = dot(normal, o);
  const V zero = hn::Zero(F{}), one = set(1.0f);
  const M facing = view.cull_back_faces ? hn::Lt(plane, zero) : hn::Ne(plane, zero);
  batch.keep = hn::And(facing, hn::Gt(o.z, set(view.near_plane)));
  if (hn::AllFalse(F{}, batch.keep)) return false;

  const V inverse_z = hn::Div(one, o.z);
  const auto [vxx, vxy, vyy, inverse, height] =
      filter_of(view, o, s, t, inverse_z, plane, load(FastSurfels::sigma), load(FastSurfels::weight));
  const V per_pixel = hn::Div(one, hn::Mul(plane, set(view.eta)));
  const V3 u0 = cross(t, o), u1 = cross(o, s);
  const V x = hn::Add(set(view.center_x), hn::Mul(hn::Mul(set(view.eta), o.x), inverse_z));
  const V y = hn::Sub(set(view.center_y), hn::Mul(hn::Mul(set(view.eta), o.y), inverse_z));
  const V values[kSplatValues] = {x,
                                  y,
                                  inverse_z,
                                  hn::Mul(normal.x, per_pixel),
                                  hn::Neg(hn::Mul(normal.y, per_pixel)),
                                  hn::Mul(u0.x, per_pixel),
                                  hn::Neg(hn::Mul(u0.y, per_pixel)),
                                  hn::Mul(u1.x, per_pixel),
                                  hn::Neg(hn::Mul(u1.y, per_pixel)),
                                  hn::Mul(vyy, inverse),
                                  hn::Mul(set(-2.0f), hn::Mul(vxy, inverse)),
                                  hn::Mul(vxx, inverse),
                                  hn::Mul(height, load(FastSurfels::red)),
                                  hn::Mul(height, load(FastSurfels::green)),
                                  hn::Mul(height, load(FastSurfels::blue)),
                                  height};
  V sum = zero;  // finite where all of them are
  for (std::size_t v = 0; v < kSplatValues; ++v) {
    hn::Store(values[v], F{}, batch.values[v]);
    sum = hn::Add(sum, hn::Mul(values[v], zero));
  }
  batch.keep = hn::And(batch.keep, hn::Eq(sum, zero));
  const V reach_x = hn::Mul(set(view.reach), hn::Sqrt(vxx)),
          reach_y = hn::Mul(set(view.reach), hn::Sqrt(vyy));
  batch.ellipse.set_columns(view, hn::Sub(x, reach_x), hn::Add(x, reach_x));
  batch.ellipse.set_rows(view, hn::Sub(y, reach_y), hn::Add(y, reach_y));
  quad_box(view, o, s, t, batch.quad);
  return true;
}

HWY_INLINE bool is_empty(const FastBox& box) {
  return box.left >= box.right || box.top >= box.bottom;
}

std::size_t prepare(const FastSurfels& surfels, const FastView& view, std::size_t begin, std::size_t end,
                    FastSplat* splats, RowRange* rows) {
  const std::size_t lanes = hn::Lanes(F{});
  std::size_t kept = 0;
  Batch batch;
  for (std::size_t i = begin; i < end; i += lanes) {
    if (!prepare_batch(surfels, view, i, batch)) continue;
    HWY_ALIGN float keep[FastSurfels::kPadding];
    hn::Store(hn::IfThenElseZero(batch.keep, set(1.0f)), F{}, keep);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (keep[lane] == 0 || i + lane >= end) continue;
      FastSplat& splat = splats[kept];
      splat.quad = batch.quad[lane];
      splat.ellipse = batch.ellipse[lane];
      if (is_empty(splat.quad) && is_empty(splat.ellipse)) continue;
      float values[kSplatValues];
      for (std::size_t v = 0; v < kSplatValues; ++v) values[v] = batch.values[v][lane];
      std::memcpy(&splat, values, sizeof values);
      rows[kept++] = {std::min(splat.quad.top, splat.ellipse.top),
                      std::max(splat.quad.bottom, splat.ellipse.bottom)};
    }
  }
  return kept;
}

// What the two loops over a box's rows in a band have in common: a register of columns and where it starts.
struct Columns {
  M within;           // the box
  V dx;               // of the pixels' centres from x_k
  float dy;           // of the first row's
  std::size_t first;  // place of the first row's pixels in the band's arrays
};

// `draw(columns, rows)` for each register of columns of the part of the box in the band.
template <class Draw>
HWY_INLINE void for_columns(const FastSplat& splat, const FastBox& box, const FastBand& band, Draw draw) {
  const int top = std::max(box.top, band.rows.top), bottom = std::min(box.bottom, band.rows.bottom);
  if (top >= bottom) return;
  const V iota = hn::Iota(F{}, 0.0f);
  for (int column = box.left; column < box.right; column += static_cast<int>(hn::Lanes(F{}))) {
    const V place = hn::Add(set(static_cast<float>(column)), iota);
    const Columns columns{
        hn::Lt(place, set(static_cast<float>(box.right))), hn::Sub(hn::Add(place, set(0.5f)), set(splat.x)),
        static_cast<float>(top) + 0.5f - splat.y,
        static_cast<std::size_t>(top - band.rows.top) * band.stride + static_cast<std::size_t>(column)};
    draw(columns, bottom - top);
  }
}

// a dx + b dy
HWY_INLINE V linear(float a, float b, const Columns& columns) {
  return hn::Add(hn::Mul(set(a), columns.dx), set(b * columns.dy));
}

void quads(std::span<const FastSplat> splats, std::span<const std::uint32_t> order, float nearest_w,
           FastBand& band) {
  const V most = set(nearest_w);
  for (const std::uint32_t k : order) {
    const FastSplat& splat = splats[k];
    for_columns(splat, splat.quad, band, [&](const Columns& columns, int rows) HWY_ATTR {
      V w = hn::Add(set(splat.w), linear(splat.w_dx, splat.w_dy, columns));
      V u0 = linear(splat.u0_dx, splat.u0_dy, columns), u1 = linear(splat.u1_dx, splat.u1_dy, columns);
      float* nearest = band.nearest.data() + columns.first;
      for (int row = 0; row < rows; ++row, nearest += band.stride) {
        const M inside = hn::And(hn::And(hn::Le(hn::Abs(u0), w), hn::Le(hn::Abs(u1), w)),
                                 hn::And(columns.within, hn::Le(w, most)));
        hn::StoreU(hn::Max(hn::LoadU(F{}, nearest), hn::IfThenElseZero(inside, w)), F{}, nearest);
        w = hn::Add(w, set(splat.w_dy));
        u0 = hn::Add(u0, set(splat.u0_dy));
        u1 = hn::Add(u1, set(splat.u1_dy));
      }
    });
  }
}

void add(std::span<const FastSplat> splats, std::span<const std::uint32_t> order, float nearest_w,
         const FastTable& table, FastBand& band) {
  const V most = set(nearest_w), limit = set(table.limit), scale = set(table.scale);
  for (const std::uint32_t k : order) {
    const FastSplat& splat = splats[k];
    for_columns(splat, splat.ellipse, band, [&](const Columns& columns, int rows) HWY_ATTR {
      V w = hn::Add(set(splat.w), linear(splat.w_dx, splat.w_dy, columns));
      // Q and what it grows by from row to row: two additions a pixel.
      V q = hn::Add(hn::Mul(linear(splat.xx, splat.xy, columns), columns.dx),
                    set(splat.yy * columns.dy * columns.dy));
      V growth = linear(splat.xy, 2.0f * splat.yy, columns);
      growth = hn::Add(growth, set(splat.yy));
      const V growth_step = set(2.0f * splat.yy);
      std::size_t pixel = columns.first;
      for (int row = 0; row < rows; ++row, pixel += band.stride) {
        const M counts =
            hn::And(hn::And(columns.within, hn::Le(q, limit)),
                    hn::And(hn::Ge(w, hn::LoadU(F{}, band.nearest.data() + pixel)), hn::Le(w, most)));
        if (!hn::AllFalse(F{}, counts)) {
          const V step = hn::Mul(hn::Min(hn::Max(q, hn::Zero(F{})), limit), scale);
          const V value =
              hn::IfThenElseZero(counts, hn::GatherIndex(F{}, table.values.data(), hn::ConvertTo(I{}, step)));
          for (std::size_t c = 0; c < 4; ++c) {
            float* sum = band.sums[c].data() + pixel;
            hn::StoreU(hn::Add(hn::LoadU(F{}, sum), hn::Mul(value, set(splat.color[c]))), F{}, sum);
          }
        }
        w = hn::Add(w, set(splat.w_dy));
        q = hn::Add(q, growth);
        growth = hn::Add(growth, growth_step);
      }
    });
  }
}

}  // namespace splatscope::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::kernels {
HWY_EXPORT(prepare);
HWY_EXPORT(quads);
HWY_EXPORT(add);

std::size_t prepare_splats(const FastSurfels& surfels, const FastView& view, std::size_t begin,
                           std::size_t end, FastSplat* splats, RowRange* rows) {
  return HWY_DYNAMIC_DISPATCH(prepare)(surfels, view, begin, end, splats, rows);
}
void draw_quads(std::span<const FastSplat> splats, std::span<const std::uint32_t> order, float nearest_w,
                FastBand& band) {
  HWY_DYNAMIC_DISPATCH(quads)(splats, order, nearest_w, band);
}
void add_splats(std::span<const FastSplat> splats, std::span<const std::uint32_t> order, float nearest_w,
                const FastTable& table, FastBand& band) {
  HWY_DYNAMIC_DISPATCH(add)(splats, order, nearest_w, table, band);
}
}  // namespace splatscope::kernels
#endif
