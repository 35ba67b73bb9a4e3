#pragma once

#include <cstdint>

#include "model/number/formats.h"

// Colours as a frame buffer stores them.
namespace splatscope {

// Bytes of a pixel; four channels of 10 bits lie in 64.
std::uint32_t bytes_per_pixel(FrameFormat format);

// What is added to a colour, in steps of a UNORM frame buffer, before it is rounded down; 0 to 1. A dither
// depends on the place: thresholds of Bayer's 4x4 matrix, at the middles of sixteen equal parts.
double rounding_offset(FrameRounding rounding, std::uint32_t x, std::uint32_t y);

// A channel as `format` holds it: UNORM clamps to [0, 1] (NaN counts as 0) and rounds down after `offset`
// steps; half rounds to nearest, ties to even, and knows no other; float32 changes nothing.
float stored_value(FrameFormat format, float value, double offset);

// Rounded to `bits` fraction bits (1 to 23) at least exponent 2^`lowest`, to nearest, ties to even; below
// it, in steps of 2^(lowest - bits). INF and NaN stay.
float rounded_fraction(float value, int bits, int lowest = -126);

}  // namespace splatscope
