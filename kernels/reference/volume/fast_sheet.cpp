// The loops of fast_volume on SIMD registers, compiled once a target and chosen at run time (Highway). Lanes
// never depend on one another and nothing is fused: every target gives the same bits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/reference/volume/fast_sheet.cpp"
#include "kernels/reference/volume/fast_sheet.h"

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "kernels/reference/simd_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::kernels::HWY_NAMESPACE {
namespace {

constexpr std::size_t kLanes = FastSurfels::kPadding;  // at most
constexpr std::size_t kSplatValues = offsetof(SheetSplat, box) / sizeof(float);

// W^T a: takes a row of the Jacobian to object space.
HWY_INLINE V3 turned_back(const FastVolumeView& view, const V3& a) {
  const auto column = [&](int c) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(set(view.rows[0][c]), a.x), hn::Mul(set(view.rows[1][c]), a.y)),
                   hn::Mul(set(view.rows[2][c]), a.z));
  };
  return {column(0), column(1), column(2)};
}
HWY_INLINE V3 scaled(const V3& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

// Splats side by side, a lane each.
struct Lanes {
  enum Component { x, y, z, nx, ny, nz, red, green, blue, weight, flatness, kComponents };
  HWY_ALIGN float values[kComponents][kLanes];
  HWY_ALIGN float variance[kVarianceTerms][kLanes];

  HWY_INLINE void load(std::size_t lane, const VolumeSplat& splat) {
    for (int i = 0; i < 3; ++i) {
      values[x + i][lane] = splat.position[i];
      values[nx + i][lane] = splat.normal[i];
      values[red + i][lane] = splat.color[i];
    }
    values[weight][lane] = splat.weight;
    values[flatness][lane] = splat.flatness;
  }
  HWY_INLINE V operator[](Component c) const { return hn::Load(F{}, values[c]); }
  HWY_INLINE V3 triple(Component c) const {
    return {hn::Load(F{}, values[c]), hn::Load(F{}, values[c + 1]), hn::Load(F{}, values[c + 2])};
  }
};

// Its determinant by itself: from these three it would be what rounding leaves of two products that are equal
// but for it, where a splat close to the eye's plane is a thousand times longer than wide.
struct Symmetric2 {
  V xx, xy, yy, determinant;
};

// The upper 2x2 of J C J^T for rows a and b of J, of C flattened along n by k (Eq. 31, 37):
// C - k (n (C n)^T + (C n) n^T) + k^2 (n C n) n n^T. Its determinant is w^T adj(C) w (Cauchy and Binet) of
// w = adj(1 - k n n^T) (a x b).
HWY_INLINE Symmetric2 projected(const V (&c)[kVarianceTerms], const V3& a, const V3& b, const V3& n, V k) {
  // Of `c` from `at` on.
  const auto times = [&](std::size_t at, const V3& v) HWY_ATTR {
    return V3{dot({c[at], c[at + 1], c[at + 2]}, v), dot({c[at + 1], c[at + 3], c[at + 4]}, v),
              dot({c[at + 2], c[at + 4], c[at + 5]}, v)};
  };
  const auto determinant = [&](const V3& w) HWY_ATTR { return dot(times(6, w), w); };
  const V3 ca = times(0, a), cb = times(0, b), w = cross(a, b);
  const Symmetric2 v{dot(a, ca), dot(a, cb), dot(b, cb), determinant(w)};
  if (hn::AllTrue(F{}, hn::Eq(k, hn::Zero(F{})))) return v;
  const V left = hn::Sub(set(1.0f), k), along = hn::Mul(k, dot(n, w));
  const V3 flat{hn::Add(hn::Mul(left, w.x), hn::Mul(along, n.x)),
                hn::Add(hn::Mul(left, w.y), hn::Mul(along, n.y)),
                hn::Add(hn::Mul(left, w.z), hn::Mul(along, n.z))};
  const V na = hn::Mul(k, dot(n, a)), nb = hn::Mul(k, dot(n, b));
  const V ca_n = dot(n, ca), cb_n = dot(n, cb), ncn = dot(n, times(0, n));
  const auto entry = [&](V initial, V p, V q, V cp, V cq) HWY_ATTR {
    return hn::Add(hn::Sub(initial, hn::Add(hn::Mul(p, cq), hn::Mul(q, cp))), hn::Mul(ncn, hn::Mul(p, q)));
  };
  return {entry(v.xx, na, na, ca_n, ca_n), entry(v.xy, na, nb, ca_n, cb_n), entry(v.yy, nb, nb, cb_n, cb_n),
          determinant(flat)};
}

// V' + V_h.
HWY_INLINE Symmetric2 prefiltered(VolumePrefilter filter, const Symmetric2& v) {
  if (filter == VolumePrefilter::none) return v;
  const V one = set(1.0f), trace = hn::Add(v.xx, v.yy);
  const V determinant = hn::Max(v.determinant, hn::Zero(F{}));
  if (filter == VolumePrefilter::ewa)
    return {hn::Add(v.xx, one), v.xy, hn::Add(v.yy, one), hn::Add(determinant, hn::Add(trace, one))};
  const V half = set(0.5f);
  const V distance = hn::Sqrt(hn::Add(square(hn::Mul(half, hn::Sub(v.xx, v.yy))), square(v.xy)));
  const V larger = hn::Add(hn::Mul(half, trace), distance);
  const V grow = hn::Max(one, hn::Div(larger, determinant));
  return {hn::Mul(v.xx, grow), hn::Mul(v.xy, grow), hn::Mul(v.yy, grow), hn::Mul(determinant, square(grow))};
}

// What becomes of the splats of one register.
struct Batch {
  HWY_ALIGN float values[kSplatValues][kLanes];  // in the order of SheetSplat's floats
  HWY_ALIGN std::int32_t left[kLanes], top[kLanes], right[kLanes], bottom[kLanes];
  HWY_ALIGN float keep[kLanes];
};

// Phong's matt and shining part.
struct Light {
  V matt, shine;
};
HWY_INLINE Light shade(const FastVolumeView& view, const SpecularTable& table, const V3& normal,
                       const V3& ray) {
  const V3 light{set(view.toward_light[0]), set(view.toward_light[1]), set(view.toward_light[2])};
  const V3 half{hn::Sub(light.x, ray.x), hn::Sub(light.y, ray.y), hn::Sub(light.z, ray.z)};
  const V one = set(1.0f);
  const V length = hn::Max(hn::Sqrt(dot(half, half)), set(1e-12f));
  const V cosine = hn::Min(hn::Div(hn::Abs(dot(normal, half)), length), one);
  const V place = hn::Mul(cosine, set(static_cast<float>(SpecularTable::kSteps)));
  const hn::Vec<I> step = hn::ConvertTo(I{}, place);
  const V low = hn::GatherIndex(F{}, table.values.data(), step);
  const V high = hn::GatherIndex(F{}, table.values.data() + 1, step);
  const V shine = hn::Add(low, hn::Mul(hn::Sub(place, hn::ConvertTo(F{}, step)), hn::Sub(high, low)));
  const V cosine_light = hn::Abs(dot(normal, light));
  const M has_normal = hn::Gt(dot(normal, normal), set(0.5f));
  return {
      hn::Add(set(view.ambient), hn::Mul(set(view.diffuse), hn::IfThenElse(has_normal, cosine_light, one))),
      hn::IfThenElseZero(has_normal, shine)};
}

// Eq. 31 without its third row and column, by the cheapest way that the kernels allow.
HWY_INLINE Symmetric2 variance(const FastVolumeView& view, const Lanes& lanes, V scale, V slope_x, V slope_y,
                               const V3& normal) {
  const V zero = hn::Zero(F{});
  if (view.kernels == FastKernels::spherical) {
    const V factor = hn::Mul(set(view.variance[0]), square(scale)), one = set(1.0f);
    return {hn::Mul(factor, hn::Add(one, square(slope_x))), hn::Mul(factor, hn::Mul(slope_x, slope_y)),
            hn::Mul(factor, hn::Add(one, square(slope_y))),
            hn::Mul(square(factor), hn::Add(one, hn::Add(square(slope_x), square(slope_y))))};
  }
  const V3 a{scale, zero, hn::Neg(hn::Mul(scale, slope_x))};
  const V3 b{zero, hn::Neg(scale), hn::Neg(hn::Mul(scale, slope_y))};
  V c[kVarianceTerms];
  const bool own = view.kernels == FastKernels::own;
  for (std::size_t i = 0; i < kVarianceTerms; ++i)
    c[i] = own ? hn::Load(F{}, lanes.variance[i]) : set(view.variance[i]);
  if (!own) return projected(c, a, b, normal, lanes[Lanes::flatness]);
  return projected(c, turned_back(view, a), turned_back(view, b), lanes.triple(Lanes::nx),
                   lanes[Lanes::flatness]);
}

// flattened_weight, of 1 - 1/s.
HWY_INLINE V flattened_weight(V cosine, V flatness) {
  const V one = set(1.0f), squared = hn::Min(square(cosine), one);
  return hn::Sqrt(hn::Add(squared, hn::Mul(hn::Sub(one, squared), square(hn::Sub(one, flatness)))));
}

HWY_INLINE void project_batch(const FastVolumeView& view, const SpecularTable& table, const Lanes& lanes,
                              Batch& batch) {
  const V one = set(1.0f), zero = hn::Zero(F{}), eta = set(view.eta);
  const V3 moved = turned(view, lanes.triple(Lanes::x));
  const V3 t{hn::Add(moved.x, set(view.rows[0][3])), hn::Add(moved.y, set(view.rows[1][3])),
             hn::Add(moved.z, set(view.rows[2][3]))};
  const V3 normal = scaled(turned(view, lanes.triple(Lanes::nx)), set(view.normal_scale));
  V scale = eta, slope_x = zero, slope_y = zero, determinant_j = square(eta);
  V3 ray{zero, zero, one};
  V x = hn::Add(set(view.center_x), hn::Mul(eta, t.x)), y = hn::Sub(set(view.center_y), hn::Mul(eta, t.y));
  if (view.perspective) {  // slopes in window coordinates, y down
    const V inverse_z = hn::Div(one, t.z), distance = hn::Sqrt(dot(t, t));
    scale = hn::Mul(eta, inverse_z);
    slope_x = hn::Mul(t.x, inverse_z);
    slope_y = hn::Neg(hn::Mul(t.y, inverse_z));
    determinant_j = hn::Mul(square(scale), hn::Mul(distance, inverse_z));
    ray = scaled(t, hn::Div(one, distance));
    x = hn::Add(set(view.center_x), hn::Mul(eta, slope_x));
    y = hn::Add(set(view.center_y), hn::Mul(eta, slope_y));
  }
  const Symmetric2 v = prefiltered(view.prefilter, variance(view, lanes, scale, slope_x, slope_y, normal));
  V opacity = hn::Mul(hn::Mul(lanes[Lanes::weight], set(view.opacity_scale)),
                      hn::Div(determinant_j, hn::Sqrt(v.determinant)));
  const V flatness = lanes[Lanes::flatness];
  opacity = hn::IfThenElse(hn::Gt(flatness, zero),
                           hn::Mul(opacity, flattened_weight(dot(normal, ray), flatness)), opacity);
  const Light light = shade(view, table, normal, ray);
  const auto color = [&](Lanes::Component c) HWY_ATTR {
    return hn::Mul(opacity, hn::Min(hn::Add(hn::Mul(lanes[c], light.matt), light.shine), one));
  };
  const V inverse = hn::Div(one, v.determinant);
  const V values[kSplatValues] = {x,
                                  y,
                                  hn::Mul(v.yy, inverse),
                                  hn::Mul(set(-2.0f), hn::Mul(v.xy, inverse)),
                                  hn::Mul(v.xx, inverse),
                                  color(Lanes::red),
                                  color(Lanes::green),
                                  color(Lanes::blue),
                                  opacity};
  V sum = hn::Mul(v.determinant, zero);  // finite where all of them are
  for (std::size_t i = 0; i < kSplatValues; ++i) {
    hn::Store(values[i], F{}, batch.values[i]);
    sum = hn::Add(sum, hn::Mul(values[i], zero));
  }
  const M within = hn::And(hn::Gt(t.z, set(view.near_plane)), hn::Le(t.z, set(view.far_plane)));
  const M keep = hn::And(within, hn::Eq(sum, zero));
  hn::Store(hn::IfThenElseZero(keep, one), F{}, batch.keep);
  const V reach_x = hn::Mul(set(view.reach), hn::Sqrt(v.xx)),
          reach_y = hn::Mul(set(view.reach), hn::Sqrt(v.yy));
  store_span(hn::Sub(x, reach_x), hn::Add(x, reach_x), view.width, batch.left, batch.right);
  store_span(hn::Sub(y, reach_y), hn::Add(y, reach_y), view.height, batch.top, batch.bottom);
}

std::size_t project(const FastVolumeView& view, const SpecularTable& table,
                    std::span<const VolumeSplat> splats, std::span<const FastVariance> kernels,
                    std::span<const std::uint32_t> numbers, std::span<const std::uint32_t> sheets,
                    SheetSplat* out, RowRange* rows) {
  const std::size_t count = hn::Lanes(F{});
  std::size_t kept = 0;
  Lanes lanes{};
  Batch batch;
  for (std::size_t i = 0; i < numbers.size(); i += count) {
    const std::size_t filled = std::min(count, numbers.size() - i);
    for (std::size_t lane = 0; lane < filled; ++lane) {
      const VolumeSplat& splat = splats[numbers[i + lane]];
      lanes.load(lane, splat);
      if (view.kernels != FastKernels::own) continue;
      for (std::size_t e = 0; e < kVarianceTerms; ++e) lanes.variance[e][lane] = kernels[splat.kernel][e];
    }
    project_batch(view, table, lanes, batch);
    for (std::size_t lane = 0; lane < filled; ++lane) {
      const FastBox box{batch.left[lane], batch.top[lane], batch.right[lane], batch.bottom[lane]};
      if (batch.keep[lane] == 0 || box.left >= box.right || box.top >= box.bottom) continue;
      const auto value = [&](std::size_t v) { return batch.values[v][lane]; };
      out[kept] = {value(0), value(1),        value(2),
                   value(3), value(4),        {value(5), value(6), value(7), value(8)},
                   box,      sheets[i + lane]};
      rows[kept++] = {box.top, box.bottom};
    }
  }
  return kept;
}

// A register of columns of one splat, downward from the band's or the box's first row.
HWY_INLINE void add_columns(const SheetSplat& splat, int column, int top, int bottom, const FastTable& table,
                            SheetBand& band) {
  const V limit = set(table.limit), scale = set(table.scale), zero = hn::Zero(F{});
  const V place = hn::Add(set(static_cast<float>(column)), hn::Iota(F{}, 0.0f));
  const M within = hn::Lt(place, set(static_cast<float>(splat.box.right)));
  const V dx = hn::Sub(hn::Add(place, set(0.5f)), set(splat.x));
  const float dy = static_cast<float>(top) + 0.5f - splat.y;
  // r, and what it grows by from row to row: two additions a pixel.
  V r =
      hn::Add(hn::Mul(hn::Add(hn::Mul(set(splat.xx), dx), set(splat.xy * dy)), dx), set(splat.yy * dy * dy));
  V growth = hn::Add(hn::Add(hn::Mul(set(splat.xy), dx), set(2.0f * splat.yy * dy)), set(splat.yy));
  const V growth_step = set(2.0f * splat.yy);
  const V red = set(splat.color[0]), green = set(splat.color[1]), blue = set(splat.color[2]),
          opacity = set(splat.color[3]);
  std::size_t pixel =
      static_cast<std::size_t>(top - band.rows.top) * band.stride + static_cast<std::size_t>(column);
  for (int row = top; row < bottom; ++row, pixel += band.stride) {
    const M counts = hn::And(within, hn::Lt(r, limit));
    const V step = hn::Mul(hn::Min(hn::Max(r, zero), limit), scale);
    const V value =
        hn::IfThenElseZero(counts, hn::GatherIndex(F{}, table.values.data(), hn::ConvertTo(I{}, step)));
    const auto add = [&](std::size_t c, V color) HWY_ATTR {
      float* sum = band.sheet[c].data() + pixel;
      hn::StoreU(hn::Add(hn::LoadU(F{}, sum), hn::Mul(value, color)), F{}, sum);
    };
    add(0, red);
    add(1, green);
    add(2, blue);
    add(3, opacity);
    r = hn::Add(r, growth);
    growth = hn::Add(growth, growth_step);
  }
}

void add(std::span<const SheetSplat> splats, std::span<const std::uint32_t> order, const FastTable& table,
         SheetBand& band) {
  FastBox dirty = band.dirty;
  for (const std::uint32_t k : order) {
    const SheetSplat& splat = splats[k];
    const int top = std::max(splat.box.top, band.rows.top);
    const int bottom = std::min(splat.box.bottom, band.rows.bottom);
    dirty = {std::min(dirty.left, splat.box.left), std::min(dirty.top, top),
             std::max(dirty.right, splat.box.right), std::max(dirty.bottom, bottom)};
    for (int column = splat.box.left; column < splat.box.right; column += static_cast<int>(hn::Lanes(F{}))) {
      add_columns(splat, column, top, bottom, table, band);
    }
  }
  band.dirty = dirty;
}

void composite(SheetBand& band) {
  const V one = set(1.0f), zero = hn::Zero(F{});
  const FastBox dirty = band.dirty;
  for (int row = dirty.top; row < dirty.bottom; ++row) {
    const std::size_t start = static_cast<std::size_t>(row - band.rows.top) * band.stride;
    for (int column = dirty.left; column < dirty.right; column += static_cast<int>(hn::Lanes(F{}))) {
      const std::size_t pixel = start + static_cast<std::size_t>(column);
      const V opacity = hn::LoadU(F{}, band.sheet[3].data() + pixel);
      const V scale = hn::Div(one, hn::Max(one, opacity));
      const V through = hn::Sub(one, hn::Mul(opacity, scale));
      for (std::size_t c = 0; c < 4; ++c) {
        float* front = band.sheet[c].data() + pixel;
        float* behind = band.picture[c].data() + pixel;
        hn::StoreU(hn::Add(hn::Mul(hn::LoadU(F{}, front), scale), hn::Mul(through, hn::LoadU(F{}, behind))),
                   F{}, behind);
        hn::StoreU(zero, F{}, front);
      }
    }
  }
  band.dirty = {static_cast<std::int32_t>(band.stride), band.rows.bottom, 0, band.rows.top};
}

}  // namespace
}  // namespace splatscope::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::kernels {
HWY_EXPORT(project);
HWY_EXPORT(add);
HWY_EXPORT(composite);

std::size_t project_splats(const FastVolumeView& view, const SpecularTable& specular,
                           std::span<const VolumeSplat> splats, std::span<const FastVariance> kernels,
                           std::span<const std::uint32_t> numbers, std::span<const std::uint32_t> sheets,
                           SheetSplat* out, RowRange* rows) {
  return HWY_DYNAMIC_DISPATCH(project)(view, specular, splats, kernels, numbers, sheets, out, rows);
}
void add_to_sheet(std::span<const SheetSplat> splats, std::span<const std::uint32_t> order,
                  const FastTable& table, SheetBand& band) {
  HWY_DYNAMIC_DISPATCH(add)(splats, order, table, band);
}
void composite_sheet(SheetBand& band) {
  HWY_DYNAMIC_DISPATCH(composite)(band);
}
}  // namespace splatscope::kernels
#endif
