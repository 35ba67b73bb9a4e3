#include "model/number/blend.h"

#include <algorithm>

#include "model/number/blend_factor.h"

namespace splatscope {
namespace {

std::uint8_t rounded(int sum) {
  return static_cast<std::uint8_t>(std::min((std::max(sum, 0) + 127) / 255, 255));
}

}  // namespace

Color8 blend_unorm8(const BlendState& state, Color8 source, Color8 destination) {
  Color8 out{};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const auto factor = [&](BlendFactor of) {
      return blend_factor(of, 255, source, destination, state.constant, channel);
    };
    const int s = source[channel] * factor(state.source_factor);
    const int d = destination[channel] * factor(state.destination_factor);
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
