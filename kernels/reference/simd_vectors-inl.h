// Lanes of surfels and voxels on SIMD registers, and their vectors in space; included once a target
// (Highway).
#if defined(SPLATSCOPE_SIMD_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATSCOPE_SIMD_VECTORS_INL_H
#undef SPLATSCOPE_SIMD_VECTORS_INL_H
#else
#define SPLATSCOPE_SIMD_VECTORS_INL_H
#endif

#include <hwy/highway.h>

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
HWY_INLINE V square(V a) {
  return hn::Mul(a, a);
}

}  // namespace splatscope::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
