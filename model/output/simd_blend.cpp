// Colours in 8 bits on SIMD registers, compiled once a target and chosen at run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/output/simd_blend.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <cstring>

#include "model/number/simd_steps-inl.h"
#include "model/output/output.h"

HWY_BEFORE_NAMESPACE();
namespace splatscope::output::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kLanes>;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
using V = hn::Vec<F>;
using VI = hn::Vec<I>;
using Pixel = hn::CappedTag<std::uint8_t, 4>;

HWY_INLINE V saturated(V value) {
  return splatscope::HWY_NAMESPACE::within(value, hn::Zero(F{}), hn::Set(F{}, 1.0f));
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
    V received = saturated(value);
    if (format == ColorFormat::unorm8) {
      received = splatscope::HWY_NAMESPACE::over_255(quantized(value));
    } else if (format == ColorFormat::unorm12) {
      received = hn::Div(hn::ConvertTo(F{}, quantized(value, steps)), hn::Set(F{}, steps));
    }
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

void pack(const std::array<const float*, 4>& colors, std::size_t count, const DrawState& state,
          std::uint32_t* packed) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    VI channel[4];
    for (std::size_t c = 0; c < 4; ++c) channel[c] = quantized(hn::LoadU(F{}, colors[c] + i));
    if (state.blend) {
      const VI alpha = channel[3];
      for (VI& value : channel) value = product(value, factor_of(state.source_factor, value, alpha));
    }
    const VI all = hn::Or(hn::Or(channel[0], hn::ShiftLeft<8>(channel[1])),
                          hn::Or(hn::ShiftLeft<16>(channel[2]), hn::ShiftLeft<24>(channel[3])));
    hn::StoreU(hn::BitCast(U{}, all), U{}, packed + i);
  }
}

void add(std::span<const std::uint32_t> packed, std::span<const std::uint32_t> pixels,
         std::span<Color8> frame) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::uint8_t* stored = frame[pixels[i]].data();
    const auto* addend = reinterpret_cast<const std::uint8_t*>(&packed[i]);
    for (std::size_t c = 0; c < 4; c += hn::Lanes(Pixel{})) {
      const auto sum = hn::SaturatedAdd(hn::LoadU(Pixel{}, stored + c), hn::LoadU(Pixel{}, addend + c));
      hn::StoreU(sum, Pixel{}, stored + c);
    }
  }
}

}  // namespace splatscope::output::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::output {
HWY_EXPORT(receive);
HWY_EXPORT(pack);
HWY_EXPORT(add);

void receive_colors(float* values, std::size_t count, ColorFormat format) {
  HWY_DYNAMIC_DISPATCH(receive)(values, count, format);
}

void pack_colors(const std::array<const float*, 4>& colors, std::size_t count, const DrawState& state,
                 std::uint32_t* packed) {
  HWY_DYNAMIC_DISPATCH(pack)(colors, count, state, packed);
}

void write_packed(std::span<const std::uint32_t> packed, std::span<const std::uint32_t> pixels,
                  const DrawState& state, Frame& frame) {
  if (state.blend) return HWY_DYNAMIC_DISPATCH(add)(packed, pixels, frame.colors8);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    std::memcpy(&frame.colors8[pixels[i]], &packed[i], sizeof packed[i]);
}
}  // namespace splatscope::output
#endif
