#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "model/number/blend.h"

namespace splatscope {

// The factor of one channel (3 is alpha) where `one` is 1: 255 of 8-bit colours, 1 of reals.
template <class Value, class Channel>
Value blend_factor(BlendFactor factor, Value one, const std::array<Channel, 4>& source,
                   const std::array<Channel, 4>& destination, const std::array<Channel, 4>& constant,
                   std::size_t channel) {
  switch (factor) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return one;
    case BlendFactor::src_color:
      return source[channel];
    case BlendFactor::inv_src_color:
      return one - source[channel];
    case BlendFactor::src_alpha:
      return source[3];
    case BlendFactor::inv_src_alpha:
      return one - source[3];
    case BlendFactor::dst_alpha:
      return destination[3];
    case BlendFactor::inv_dst_alpha:
      return one - destination[3];
    case BlendFactor::dst_color:
      return destination[channel];
    case BlendFactor::inv_dst_color:
      return one - destination[channel];
    case BlendFactor::src_alpha_saturate:
      return channel == 3 ? one : std::min<Value>(source[3], one - destination[3]);
    case BlendFactor::constant_color:
      return constant[channel];
    case BlendFactor::inv_constant_color:
      return one - constant[channel];
    case BlendFactor::constant_alpha:
      return constant[3];
    case BlendFactor::inv_constant_alpha:
      return one - constant[3];
  }
  return 0;
}

}  // namespace splatscope
