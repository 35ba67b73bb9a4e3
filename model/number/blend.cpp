#include "model/number/blend.h"

#include <algorithm>

namespace splatscope {
namespace {

// The 8-bit factor of one channel (3 is alpha).
int factor_of(BlendFactor factor, const BlendState& state, Color8 source, Color8 destination,
              std::size_t channel) {
  switch (factor) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return 255;
    case BlendFactor::src_color:
      return source[channel];
    case BlendFactor::inv_src_color:
      return 255 - source[channel];
    case BlendFactor::src_alpha:
      return source[3];
    case BlendFactor::inv_src_alpha:
      return 255 - source[3];
    case BlendFactor::dst_alpha:
      return destination[3];
    case BlendFactor::inv_dst_alpha:
      return 255 - destination[3];
    case BlendFactor::dst_color:
      return destination[channel];
    case BlendFactor::inv_dst_color:
      return 255 - destination[channel];
    case BlendFactor::src_alpha_saturate:
      return channel == 3 ? 255 : std::min<int>(source[3], 255 - destination[3]);
    case BlendFactor::constant_color:
      return state.constant[channel];
    case BlendFactor::inv_constant_color:
      return 255 - state.constant[channel];
    case BlendFactor::constant_alpha:
      return state.constant[3];
    case BlendFactor::inv_constant_alpha:
      return 255 - state.constant[3];
  }
  return 0;
}

std::uint8_t rounded(int sum) {
  return static_cast<std::uint8_t>(std::min((std::max(sum, 0) + 127) / 255, 255));
}

}  // namespace

Color8 blend_unorm8(const BlendState& state, Color8 source, Color8 destination) {
  Color8 out{};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const int s = source[channel] * factor_of(state.source_factor, state, source, destination, channel);
    const int d =
        destination[channel] * factor_of(state.destination_factor, state, source, destination, channel);
    switch (state.equation) {
      case BlendEquation::add:
        out[channel] = rounded(s + d);
        break;
      case BlendEquation::subtract:
        out[channel] = rounded(s - d);
        break;
      case BlendEquation::reverse_subtract:
        out[channel] = rounded(d - s);
        break;
      case BlendEquation::min:
        out[channel] = std::min(source[channel], destination[channel]);
        break;
      case BlendEquation::max:
        out[channel] = std::max(source[channel], destination[channel]);
        break;
    }
  }
  return out;
}

}  // namespace splatscope
