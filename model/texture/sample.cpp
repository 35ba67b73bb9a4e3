// Compiled once a target and chosen at run time (Highway): the places of the texels vectorise.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/texture/sample.cpp"
#include "model/texture/sample.h"

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "model/number/simd_steps-inl.h"
#include "model/work/work.h"

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
using VF = hn::Vec<F>;
using VU = hn::Vec<U>;
constexpr std::size_t kAtOnce = 64;

// The texels of coordinates along a side of so many texels.
HWY_INLINE VU places(VF coordinates, VF texels) {
  const VF last = hn::Sub(texels, hn::Set(F{}, 1.0f));
  const VF place = splatscope::HWY_NAMESPACE::within(hn::Mul(coordinates, texels), hn::Zero(F{}), last);
  return hn::BitCast(U{}, splatscope::HWY_NAMESPACE::integer(place));
}

// The numbers of the texels at `count` coordinates, and (where wanted) of the blocks that these are in.
HWY_INLINE void find_texels(const Texture& texture, const float* u, const float* v, std::size_t count,
                            std::uint32_t* texels, std::uint32_t* blocks) {
  static_assert(std::has_single_bit(kTexelBlockEdge));
  constexpr int kEdgeBits = std::countr_zero(kTexelBlockEdge);
  const VU width = hn::Set(U{}, texture.width),
           blocks_in_row = hn::Set(U{}, (texture.width + kTexelBlockEdge - 1) / kTexelBlockEdge);
  const VF columns = hn::Set(F{}, static_cast<float>(texture.width)),
           rows = hn::Set(F{}, static_cast<float>(texture.height));
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{})) {
    const VU x = places(hn::LoadU(F{}, u + i), columns), y = places(hn::LoadU(F{}, v + i), rows);
    hn::Store(hn::Add(hn::Mul(y, width), x), U{}, texels + i);
    if (blocks != nullptr)
      hn::Store(hn::Add(hn::Mul(hn::ShiftRight<kEdgeBits>(y), blocks_in_row), hn::ShiftRight<kEdgeBits>(x)),
                U{}, blocks + i);
  }
}

// Texels as alpha.
HWY_INLINE void look_up(const Texture& texture, const std::uint32_t* texels, std::size_t count,
                        float* alpha) {
  if (texture.bits != 8) {
    for (std::size_t i = 0; i < count; ++i) alpha[i] = wide_texel(texture, texels[i]);
    return;
  }
  alignas(64) std::int32_t levels[kAtOnce];
  for (std::size_t i = 0; i < count; ++i) levels[i] = texture.texels[texels[i]];
  alignas(64) float values[kAtOnce];
  for (std::size_t i = 0; i < count; i += hn::Lanes(F{}))
    hn::Store(splatscope::HWY_NAMESPACE::over_255(hn::Load(I{}, levels + i)), F{}, values + i);
  std::copy_n(values, count, alpha);
}

void sample(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
            std::span<std::uint32_t> blocks) {
  alignas(64) std::uint32_t texels[kAtOnce], of_texels[kAtOnce];
  for (std::size_t first = 0; first < alpha.size(); first += kAtOnce) {
    const std::size_t count = std::min(alpha.size() - first, kAtOnce);
    find_texels(texture, u + first, v + first, count, texels, blocks.empty() ? nullptr : of_texels);
    look_up(texture, texels, count, alpha.data() + first);
    if (!blocks.empty()) std::copy_n(of_texels, count, blocks.data() + first);
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
