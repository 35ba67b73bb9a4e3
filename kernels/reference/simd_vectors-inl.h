// Lanes of surfels and voxels on SIMD registers, and their vectors in space; included once a target
// (Highway).
#if defined(SPLATSCOPE_SIMD_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATSCOPE_SIMD_VECTORS_INL_H
#undef SPLATSCOPE_SIMD_VECTORS_INL_H
#else
#define SPLATSCOPE_SIMD_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kernels/reference/fast_splat.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, FastSurfels::kPadding>;
using I = hn::RebindToSigned<F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;

struct V3 {
  V x, y, z;
};

HWY_INLINE V set(float value) {
  return hn::Set(F{}, value);
}
HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  const auto minor = [](V p, V q, V r, V s) HWY_ATTR { return hn::Sub(hn::Mul(p, s), hn::Mul(q, r)); };
  return {minor(a.y, a.z, b.y, b.z), minor(a.z, a.x, b.z, b.x), minor(a.x, a.y, b.x, b.y)};
}
// A direction of object space in camera space.
HWY_INLINE V3 turned(const FastCamera& camera, const V3& a) {
  const auto row = [&](int r) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(set(camera.rows[r][0]), a.x), hn::Mul(set(camera.rows[r][1]), a.y)),
                   hn::Mul(set(camera.rows[r][2]), a.z));
  };
  return {row(0), row(1), row(2)};
}
HWY_INLINE V square(V a) {
  return hn::Mul(a, a);
}
// Pixels of 0 to `size` whose centres lie between low and high: from `first` to before `last`.
HWY_INLINE void store_span(V low, V high, float size, std::int32_t* first, std::int32_t* last) {
  const V zero = hn::Zero(F{}), most = set(size), half = set(0.5f);
  hn::Store(hn::ConvertTo(I{}, hn::Min(hn::Max(hn::Ceil(hn::Sub(low, half)), zero), most)), I{}, first);
  hn::Store(hn::ConvertTo(I{}, hn::Min(hn::Max(hn::Floor(hn::Add(high, half)), zero), most)), I{}, last);
}

}  // namespace splatscope::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
