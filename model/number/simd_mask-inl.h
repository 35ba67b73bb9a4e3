// Masks of SIMD registers as numbers, lane n in bit n; included once a target (Highway).
#if defined(SPLATSCOPE_SIMD_MASK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATSCOPE_SIMD_MASK_INL_H
#undef SPLATSCOPE_SIMD_MASK_INL_H
#else
#define SPLATSCOPE_SIMD_MASK_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace splatscope::HWY_NAMESPACE {

// As one word: bytes would have to be put together.
static_assert(std::endian::native == std::endian::little);
template <class D>
using MaskBits = std::conditional_t<(hwy::HWY_NAMESPACE::MaxLanes(D{}) > 8), std::uint16_t, std::uint8_t>;

template <class D>
HWY_INLINE std::uint64_t bits_of(D lanes, hwy::HWY_NAMESPACE::Mask<D> mask) {
  static_assert(hwy::HWY_NAMESPACE::MaxLanes(D{}) <= 16);
  std::uint8_t bytes[8] = {};
  hwy::HWY_NAMESPACE::StoreMaskBits(lanes, mask, bytes);
  MaskBits<D> bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<D> mask_of(D lanes, std::uint64_t number) {
  const auto bits = static_cast<MaskBits<D>>(number);
  std::uint8_t bytes[8] = {};
  std::memcpy(bytes, &bits, sizeof bits);
  return hwy::HWY_NAMESPACE::LoadMaskBits(lanes, bytes);
}

}  // namespace splatscope::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
