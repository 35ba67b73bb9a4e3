#include "model/number/frame_value.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splatscope {
namespace {

constexpr std::array<std::array<int, 4>, 4> kBayer{
    {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}}};

constexpr float kLargestHalf = 65504;

// Of the range: a whole number of steps is not rounded down to the one before by what the few binary32
// operations that made it are off, half a unit in the last place each.
constexpr double kSlack = 0x1p-23;

float unorm(double value, double steps, double offset) {
  if (!(value > 0)) return 0;
  return static_cast<float>(std::min(std::floor((value + kSlack) * steps + offset), steps) / steps);
}

}  // namespace

std::uint32_t bytes_per_pixel(FrameFormat format) {
  switch (format) {
    case FrameFormat::unorm8:
      return 4;
    case FrameFormat::float32:
      return 16;
    default:
      return 8;
  }
}

double rounding_offset(FrameRounding rounding, std::uint32_t x, std::uint32_t y) {
  switch (rounding) {
    case FrameRounding::nearest:
      return 0.5;
    case FrameRounding::truncate:
      return 0;
    case FrameRounding::dither:
      break;
  }
  return (kBayer[y % 4][x % 4] + 0.5) / 16;
}

float stored_value(FrameFormat format, float value, double offset) {
  switch (format) {
    case FrameFormat::unorm8:
      return unorm(value, 255, offset);
    case FrameFormat::unorm10:
      return unorm(value, 1023, offset);
    case FrameFormat::unorm16:
      return unorm(value, 65535, offset);
    case FrameFormat::half: {
      const float rounded = rounded_fraction(value, 10, -14);
      return std::abs(rounded) > kLargestHalf ? std::copysign(std::numeric_limits<float>::infinity(), value)
                                              : rounded;
    }
    case FrameFormat::float32:
      break;
  }
  return value;
}

float rounded_fraction(float value, int bits, int lowest) {
  if (!std::isfinite(value) || value == 0) return value;
  const int exponent = bits - std::max(std::ilogb(value), lowest);
  return static_cast<float>(std::ldexp(std::nearbyint(std::ldexp(double{value}, exponent)), -exponent));
}

}  // namespace splatscope
