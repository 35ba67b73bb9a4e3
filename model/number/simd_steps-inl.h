// Floats, their bounds and whole numbers on SIMD registers; included once a target (Highway).
#if defined(SPLATSCOPE_SIMD_STEPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATSCOPE_SIMD_STEPS_INL_H
#undef SPLATSCOPE_SIMD_STEPS_INL_H
#else
#define SPLATSCOPE_SIMD_STEPS_INL_H
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

// value > low ? (value < high ? value : high) : low: what is no number becomes `low`, and a zero that bound.
// So x86 has it in two instructions.
template <typename V>
HWY_INLINE V within(V value, V low, V high) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_ARCH_X86_64 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
  return hn::Min(hn::Max(value, low), high);
#else
  const V raised = hn::IfThenElse(hn::Gt(value, low), value, low);
  return hn::IfThenElse(hn::Lt(raised, high), raised, high);
#endif
}

// n / 255.0f of integers 0 to 255, without a division: the fraction's bytes are n n n ..., of which three are
// an exact product, and what follows rounds it up by one in its last place.
template <typename VI>
HWY_INLINE auto over_255(VI n) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<VI> integers;
  const hn::RebindToFloat<decltype(integers)> floats;
  const auto bytes = hn::Mul(hn::ConvertTo(floats, n), hn::Set(floats, 0x010101p-24f));
  return hn::BitCast(floats, hn::Add(hn::BitCast(integers, bytes), hn::Min(n, hn::Set(integers, 1))));
}

}  // namespace splatscope::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
