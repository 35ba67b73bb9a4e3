// Projection on SIMD registers of doubles, compiled once a target and chosen at run time (Highway): the
// operations of assemble(), in the same order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/primitive/simd_project.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <limits>

#include "model/primitive/primitive.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::primitive::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kProjectionLanes>;
using F = hn::Rebind<float, D>;
using I = hn::Rebind<std::int32_t, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V set(double value) {
  return hn::Set(D{}, value);
}
HWY_INLINE V bit_where(M mask, std::int32_t bit) {
  return hn::IfThenElseZero(mask, set(bit));
}

void project(const std::array<const float*, 4>& position, std::size_t count, const Viewport& viewport,
             ProjectedVertices& out, std::size_t first) {
  const V zero = hn::Zero(D{}), one = set(1), half = set(0.5), centre = set(kPixelCentre);
  const V width = set(viewport.width), height = set(viewport.height);
  const V guard_x = set(2 * kGuardBand / viewport.width - 1),
          guard_y = set(2 * kGuardBand / viewport.height - 1);
  for (std::size_t i = 0; i < count; i += hn::Lanes(D{})) {
    const auto read = [&](std::size_t c)
                          HWY_ATTR { return hn::PromoteTo(D{}, hn::LoadU(F{}, position[c] + i)); };
    const V x = read(0), y = read(1), z = read(2), w = read(3);
    const auto negative = [&](V value) HWY_ATTR { return hn::Lt(value, zero); };
    // Signs of exact sums, as Plane::distance has them.
    const M finite =
        hn::And(hn::And(hn::IsFinite(x), hn::IsFinite(y)), hn::And(hn::IsFinite(z), hn::IsFinite(w)));
    const V reach_x = hn::Mul(guard_x, w), reach_y = hn::Mul(guard_y, w);
    M cut = hn::Or(negative(z), negative(hn::Sub(w, set(std::numeric_limits<float>::min()))));
    cut = hn::Or(cut, negative(hn::Sub(w, z)));
    cut = hn::Or(cut, hn::Or(negative(hn::Add(x, reach_x)), negative(hn::Sub(reach_x, x))));
    cut = hn::Or(cut, hn::Or(negative(hn::Add(y, reach_y)), negative(hn::Sub(reach_y, y))));
    // A sum of bits.
    V outside = bit_where(hn::Or(cut, hn::Not(finite)), kNotPlain);
    outside = hn::Add(outside, bit_where(negative(hn::Add(x, w)), 1));
    outside = hn::Add(outside, bit_where(negative(hn::Sub(w, x)), 2));
    outside = hn::Add(outside, bit_where(negative(hn::Add(y, w)), 4));
    outside = hn::Add(outside, bit_where(negative(hn::Sub(w, y)), 8));
    hn::StoreU(hn::DemoteTo(I{}, outside), I{}, out.outside.data() + first + i);

    const V inverse_w = hn::Div(one, w);
    const V right = hn::Add(one, hn::Mul(x, inverse_w)), down = hn::Sub(one, hn::Mul(y, inverse_w));
    hn::StoreU(hn::Add(hn::Mul(hn::Mul(right, half), width), centre), D{}, out.x.data() + first + i);
    hn::StoreU(hn::Add(hn::Mul(hn::Mul(down, half), height), centre), D{}, out.y.data() + first + i);
    hn::StoreU(hn::Mul(z, inverse_w), D{}, out.z.data() + first + i);
    hn::StoreU(inverse_w, D{}, out.inverse_w.data() + first + i);
  }
}

}  // namespace splatscope::primitive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::primitive {
HWY_EXPORT(project);

void project(const std::array<const float*, 4>& position, std::size_t count, const Viewport& viewport,
             ProjectedVertices& out, std::size_t first) {
  HWY_DYNAMIC_DISPATCH(project)(position, count, viewport, out, first);
}
}  // namespace splatscope::primitive
#endif
