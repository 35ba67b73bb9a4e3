// Colours in 8 bits on SIMD registers, compiled once a target and chosen at run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/output/simd_blend.cpp"
#include "model/output/simd_blend.h"

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <cstring>

#include "model/number/simd_integer-inl.h"
#include "model/output/output.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::output::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kLanes>;
using I = hn::RebindToSigned<F>;
using V = hn::Vec<F>;
using VI = hn::Vec<I>;
using Pixel = hn::CappedTag<std::uint8_t, 4>;

HWY_INLINE V saturated(V value) {
  return hn::IfThenElseZero(hn::Gt(value, hn::Zero(F{})), hn::Min(value, hn::Set(F{}, 1.0f)));
}
// quantize_unorm8 where `steps` is 255
HWY_INLINE VI quantized(V value, float steps = 255) {
  return splatscope::HWY_NAMESPACE::integer(
      hn::Add(hn::Mul(saturated(value), hn::Set(F{}, steps)), hn::Set(F{}, 0.5f)));
}

void receive(float* values, std::size_t count, ColorFormat format) {
  const float steps = format == ColorFormat::unorm12 ? 4095 : 255;
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    const V value = hn::LoadU(F{}, values + i);
    const V received = format == ColorFormat::float32
                           ? saturated(value)
                           : hn::Div(hn::ConvertTo(F{}, quantized(value, steps)), hn::Set(F{}, steps));
    hn::StoreU(received, F{}, values + i);
  }
}

// The 8-bit factor of one channel.
HWY_INLINE VI factor_of(BlendFactor factor, VI color, VI alpha) {
  const VI whole = hn::Set(I{}, 255);
  switch (factor) {
    case BlendFactor::one:
      return whole;
    case BlendFactor::src_color:
      return color;
    case BlendFactor::inv_src_color:
      return hn::Sub(whole, color);
    case BlendFactor::src_alpha:
      return alpha;
    case BlendFactor::inv_src_alpha:
      return hn::Sub(whole, alpha);
    default:
      return hn::Zero(I{});
  }
}

// floor((2 a b + 255) / 510): a b / 255, rounded to nearest. For a, b to 255 this is floor((a b + 127) /
// 255).
HWY_INLINE VI product(VI a, VI b) {
  const VI t = hn::Add(hn::Mul(a, b), hn::Set(I{}, 127));
  return hn::ShiftRight<8>(hn::Add(hn::Add(t, hn::Set(I{}, 1)), hn::ShiftRight<8>(t)));
}

void add(const std::array<const float*, 4>& colors, std::span<const std::uint32_t> pixels,
         const DrawState& state, std::span<Color8> frame) {
  constexpr std::size_t kAtOnce = 64;
  alignas(64) std::int32_t packed[kAtOnce];  // r in the lowest byte
  for (std::size_t first = 0; first < pixels.size(); first += kAtOnce) {
    const std::size_t count = std::min(pixels.size() - first, kAtOnce);
    for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
      VI channel[4];
      for (std::size_t c = 0; c < 4; ++c) channel[c] = quantized(hn::LoadU(F{}, colors[c] + first + i));
      if (state.blend) {
        const VI alpha = channel[3];
        for (VI& value : channel) value = product(value, factor_of(state.source_factor, value, alpha));
      }
      hn::Store(hn::Or(hn::Or(channel[0], hn::ShiftLeft<8>(channel[1])),
                       hn::Or(hn::ShiftLeft<16>(channel[2]), hn::ShiftLeft<24>(channel[3]))),
                I{}, packed + i);
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::uint8_t* stored = frame[pixels[first + i]].data();
      if (state.blend) {
        const auto* addend = reinterpret_cast<const std::uint8_t*>(packed + i);
        for (std::size_t c = 0; c < 4; c += hn::Lanes(Pixel{})) {
          const auto sum = hn::SaturatedAdd(hn::LoadU(Pixel{}, stored + c), hn::LoadU(Pixel{}, addend + c));
          hn::StoreU(sum, Pixel{}, stored + c);
        }
      } else {
        std::memcpy(stored, packed + i, 4);
      }
    }
  }
}

}  // namespace splatscope::output::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::output {
HWY_EXPORT(receive);
HWY_EXPORT(add);

void receive_colors(float* values, std::size_t count, ColorFormat format) {
  HWY_DYNAMIC_DISPATCH(receive)(values, count, format);
}

void add_unorm8(const std::array<const float*, 4>& colors, std::span<const std::uint32_t> pixels,
                const DrawState& state, std::span<Color8> frame) {
  HWY_DYNAMIC_DISPATCH(add)(colors, pixels, state, frame);
}
}  // namespace splatscope::output
#endif
