// Floats to integers on SIMD registers; included once a target (Highway).
#if defined(SPLATSCOPE_SIMD_INTEGER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATSCOPE_SIMD_INTEGER_INL_H
#undef SPLATSCOPE_SIMD_INTEGER_INL_H
#else
#define SPLATSCOPE_SIMD_INTEGER_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace splatscope::HWY_NAMESPACE {

// Toward zero, of floats that fit, in the widest registers of the target. hn::ConvertTo would also saturate
// what does not fit.
template <typename V>
HWY_INLINE auto integer(V value) {
  const hwy::HWY_NAMESPACE::RebindToSigned<hwy::HWY_NAMESPACE::DFromV<V>> integers;
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128 || !HWY_ARCH_X86_64
  return hwy::HWY_NAMESPACE::ConvertTo(integers, value);
#else
  using Integers = hwy::HWY_NAMESPACE::Vec<decltype(integers)>;
#if HWY_TARGET <= HWY_AVX3
  return Integers{_mm512_cvttps_epi32(value.raw)};
#elif HWY_TARGET <= HWY_AVX2
  return Integers{_mm256_cvttps_epi32(value.raw)};
#else
  return Integers{_mm_cvttps_epi32(value.raw)};
#endif
#endif
}

}  // namespace splatscope::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
