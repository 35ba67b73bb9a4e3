// Compiled once a target and chosen at run time (Highway): the places of the texels vectorise.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/texture/sample.cpp"
#include "model/texture/sample.h"

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <array>

HWY_BEFORE_NAMESPACE();
namespace splatscope::texture::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
constexpr std::size_t kAtOnce = 64;

// The texel of each coordinate along one side of `size` texels.
HWY_INLINE void places(const float* coordinates, std::uint32_t size, std::size_t count, std::int32_t* out) {
  const auto zero = hn::Zero(F{}), texels = hn::Set(F{}, static_cast<float>(size)),
             last = hn::Set(F{}, static_cast<float>(size - 1));
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    const auto scaled = hn::Mul(hn::LoadU(F{}, coordinates + i), texels);
    const auto clamped = hn::IfThenElseZero(hn::Gt(scaled, zero), hn::Min(scaled, last));
    hn::StoreU(hn::ConvertTo(I{}, clamped), I{}, out + i);
  }
}

constexpr std::array<float, 256> unorm8_values() {
  std::array<float, 256> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) / 255.0f;
  return values;
}
constexpr std::array<float, 256> kUnorm8 = unorm8_values();

void sample(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
            std::span<std::uint32_t> blocks) {
  const std::uint32_t blocks_in_row = (texture.width + kTexelBlockEdge - 1) / kTexelBlockEdge;
  for (std::size_t first = 0; first < alpha.size(); first += kAtOnce) {
    const std::size_t count = std::min(alpha.size() - first, kAtOnce);
    alignas(64) std::int32_t x[kAtOnce], y[kAtOnce];
    places(u + first, texture.width, count, x);
    places(v + first, texture.height, count, y);
    for (std::size_t i = 0; i < count; ++i) {
      const auto column = static_cast<std::uint32_t>(x[i]), row = static_cast<std::uint32_t>(y[i]);
      alpha[first + i] = kUnorm8[texture.texels[row * std::size_t{texture.width} + column]];
      if (!blocks.empty())
        blocks[first + i] = (row / kTexelBlockEdge) * blocks_in_row + column / kTexelBlockEdge;
    }
  }
}

}  // namespace splatscope::texture::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::texture {
HWY_EXPORT(sample);

void sample_nearest(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
                    std::span<std::uint32_t> blocks) {
  HWY_DYNAMIC_DISPATCH(sample)(texture, u, v, alpha, blocks);
}
}  // namespace splatscope::texture
#endif
