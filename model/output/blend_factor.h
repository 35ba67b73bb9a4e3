#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "model/command/commands.h"

namespace splatscope::output {

// The factor of one channel in a frame buffer of floating-point numbers.
template <class Real>
Real blend_factor(BlendFactor factor, const std::array<Real, 4>& source,
                  const std::array<Real, 4>& destination, std::size_t channel) {
  switch (factor) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return 1;
    case BlendFactor::src_color:
      return source[channel];
    case BlendFactor::inv_src_color:
      return 1 - source[channel];
    case BlendFactor::src_alpha:
      return source[3];
    case BlendFactor::inv_src_alpha:
      return 1 - source[3];
    case BlendFactor::dst_alpha:
      return destination[3];
    case BlendFactor::inv_dst_alpha:
      return 1 - destination[3];
    case BlendFactor::dst_color:
      return destination[channel];
    case BlendFactor::inv_dst_color:
      return 1 - destination[channel];
    case BlendFactor::src_alpha_saturate:
      return channel == 3 ? 1 : std::min(source[3], 1 - destination[3]);
    default:  // no draw can name the factors of a constant colour
      return 0;
  }
}

// What a draw leaves of a pixel in such a frame buffer.
template <class Real>
std::array<Real, 4> blended(const std::array<Real, 4>& source, const std::array<Real, 4>& destination,
                            const DrawState& state) {
  if (!state.blend) return source;
  std::array<Real, 4> out;
  for (std::size_t c = 0; c < 4; ++c) {
    out[c] = source[c] * blend_factor(state.source_factor, source, destination, c) +
             destination[c] * blend_factor(state.destination_factor, source, destination, c);
  }
  return out;
}

}  // namespace splatscope::output
