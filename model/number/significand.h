#pragma once

#include <bit>
#include <cstdint>

namespace splatscope {

// A normal number rounded to `bits` significant bits (2 to 24), to nearest, ties to even, whatever the mode
// of the processor. INF, NaN and zero stay.
inline float rounded_significand(float value, int bits) {
  const auto pattern = std::bit_cast<std::uint32_t>(value);
  const int dropped = 24 - bits;
  if (dropped == 0 || (pattern & 0x7f800000u) == 0x7f800000u) return value;
  const std::uint32_t half = (1u << (dropped - 1)) - 1 + (pattern >> dropped & 1u);
  return std::bit_cast<float>((pattern + half) >> dropped << dropped);
}

}  // namespace splatscope
