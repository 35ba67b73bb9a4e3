#pragma once

#include <algorithm>
#include <cstdint>

#include "model/output/frame.h"

// The last stage: depth test, blending, clearing.
namespace splatscope::output {

// Window z as the depth buffer stores it. z is clamped to [0, 1]; NaN counts as 0.
std::uint32_t quantize_depth(float z, DepthFormat format);

// A colour component clamped to [0, 1]; NaN counts as 0.
inline float saturate(float value) {
  return value > 0 ? std::min(value, 1.0f) : 0.0f;
}

// A float colour component as 8 bits: clamped to [0, 1], round to nearest; NaN counts as 0.
std::uint8_t quantize_unorm8(float value);

void clear(const Clear& command, Frame& frame);

// Tests and, where `state` says so, writes the depth of one pixel. True: the fragment lives.
bool test_depth(std::uint32_t depth, std::size_t pixel, const DrawState& state, Frame& frame);

// Writes or blends one fragment's colour (r g b a) into its pixel. In an 8-bit frame the colour is quantised
// first and the blend rounds once (number/blend.h).
void write_color(const Vec4& color, std::size_t pixel, const DrawState& state, Frame& frame);

// What the host does to the frame that it has read back: r, g and b divided by the summed weights in alpha,
// alpha set to 1. Pixels of weight 0 stay as they are. Ren 2002, section 7.
void normalize(Frame& frame);

}  // namespace splatscope::output
