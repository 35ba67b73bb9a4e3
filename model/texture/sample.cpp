// Compiled once a target and chosen at run time (Highway): the places of the texels vectorise.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/texture/sample.cpp"
#include "model/texture/sample.h"

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "model/number/simd_steps-inl.h"

namespace splatscope::texture {
// Of any depth. Read once a target, hence declared again.  NOLINTNEXTLINE(readability-redundant-declaration)
float wide_texel(const Texture& texture, std::size_t index);
}  // namespace splatscope::texture

HWY_BEFORE_NAMESPACE();
namespace splatscope::texture::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
constexpr std::size_t kAtOnce = 64;

// The texel of each coordinate along one side of `size` texels.
HWY_INLINE void places(const float* coordinates, std::uint32_t size, std::size_t count, std::int32_t* out) {
  const auto zero = hn::Zero(F{}), texels = hn::Set(F{}, static_cast<float>(size)),
             last = hn::Set(F{}, static_cast<float>(size - 1));
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    const auto scaled = hn::Mul(hn::LoadU(F{}, coordinates + i), texels);
    const auto within = splatscope::HWY_NAMESPACE::within(scaled, zero, last);
    hn::StoreU(splatscope::HWY_NAMESPACE::integer(within), I{}, out + i);
  }
}

// The texels of `count` places as alpha.
HWY_INLINE void look_up(const Texture& texture, const std::int32_t* x, const std::int32_t* y,
                        std::size_t count, float* alpha) {
  alignas(64) std::uint32_t index[kAtOnce];
  const auto width = hn::Set(U{}, texture.width);
  for (std::size_t i = 0; i < count; i += hn::Lanes(U{})) {
    const auto column = hn::BitCast(U{}, hn::Load(I{}, x + i)), row = hn::BitCast(U{}, hn::Load(I{}, y + i));
    hn::Store(hn::Add(hn::Mul(row, width), column), U{}, index + i);
  }
  if (texture.bits != 8) {
    for (std::size_t i = 0; i < count; ++i) alpha[i] = wide_texel(texture, index[i]);
    return;
  }
  alignas(64) std::int32_t texels[kAtOnce];
  for (std::size_t i = 0; i < count; ++i) texels[i] = texture.texels[index[i]];
  alignas(64) float values[kAtOnce];
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{}))
    hn::Store(splatscope::HWY_NAMESPACE::over_255(hn::Load(I{}, texels + i)), F{}, values + i);
  std::copy_n(values, count, alpha);
}

void sample(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
            std::span<std::uint32_t> blocks) {
  const std::uint32_t blocks_in_row = (texture.width + kTexelBlockEdge - 1) / kTexelBlockEdge;
  for (std::size_t first = 0; first < alpha.size(); first += kAtOnce) {
    const std::size_t count = std::min(alpha.size() - first, kAtOnce);
    alignas(64) std::int32_t x[kAtOnce], y[kAtOnce];
    places(u + first, texture.width, count, x);
    places(v + first, texture.height, count, y);
    look_up(texture, x, y, count, alpha.data() + first);
    for (std::size_t i = 0; i < (blocks.empty() ? 0 : count); ++i) {
      const auto column = static_cast<std::uint32_t>(x[i]), row = static_cast<std::uint32_t>(y[i]);
      blocks[first + i] = (row / kTexelBlockEdge) * blocks_in_row + column / kTexelBlockEdge;
    }
  }
}

}  // namespace splatscope::texture::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatscope::texture {
HWY_EXPORT(sample);

float wide_texel(const Texture& texture, std::size_t index) {
  const int level = texture.bits > 8 ? texture.texels[2 * index] + 256 * texture.texels[2 * index + 1]
                                     : texture.texels[index];
  return static_cast<float>(level) / static_cast<float>((1 << texture.bits) - 1);
}

namespace {

// The texels on both sides of a coordinate along one side of the texture, and the weight of the second.
struct Between {
  std::size_t first = 0, second = 0;
  float weight = 0;
};

Between between(float coordinate, std::uint32_t size, int weight_bits) {
  const float last = static_cast<float>(size - 1), steps = static_cast<float>(1 << weight_bits);
  const float place = coordinate * static_cast<float>(size) - 0.5f;
  const float clamped = place > 0 ? std::min(place, last) : 0;
  const float first = std::floor(clamped);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(std::min(first + 1, last)),
          std::floor((clamped - first) * steps + 0.5f) / steps};
}

}  // namespace

void sample_bilinear(const Texture& texture, int weight_bits, const float* u, const float* v,
                     std::span<float> alpha) {
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    const Between x = between(u[i], texture.width, weight_bits),
                  y = between(v[i], texture.height, weight_bits);
    const auto row = [&](std::size_t at) {
      const float left = wide_texel(texture, at * texture.width + x.first);
      return left + x.weight * (wide_texel(texture, at * texture.width + x.second) - left);
    };
    const float upper = row(y.first);
    alpha[i] = upper + y.weight * (row(y.second) - upper);
  }
}

void sample_nearest(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
                    std::span<std::uint32_t> blocks) {
  HWY_DYNAMIC_DISPATCH(sample)(texture, u, v, alpha, blocks);
}
}  // namespace splatscope::texture
#endif
