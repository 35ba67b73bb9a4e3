#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

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

// The colours of fragments as the pixel unit receives them, in place: saturated, and rounded to 8 or 12 bits
// where the format says so. The array has room for a whole number of kLanes.
inline constexpr std::size_t kLanes = 16;
void receive_colors(float* values, std::size_t count, ColorFormat format);

// Writes or blends the colours (r, g, b, a: an array each, with room for a whole number of kLanes) of
// fragments into their pixels, one after the other. A fixed-point frame clamps a colour before its factors
// (Direct3D's rule), one of 8 bits that rounds to nearest quantises it, and the blend rounds once
// (number/blend.h).
void write_colors(const std::array<const float*, 4>& colors, std::span<const std::uint32_t> pixels,
                  const DrawState& state, Frame& frame);

// The same in two steps where a draw packs(): into an 8-bit frame without blending, or with a destination
// factor of one and a source factor that does not depend on the destination. Under the one rounding of such a
// blend the destination is added whole, so all but that addition may be done at any time, in any order.
bool packs(const DrawState& state, const NumberFormats& formats);
// What is added to each pixel, or takes its place: r in the lowest byte. `packed` has room like the colours.
void pack_colors(const std::array<const float*, 4>& colors, std::size_t count, const DrawState& state,
                 std::uint32_t* packed);
void write_packed(std::span<const std::uint32_t> packed, std::span<const std::uint32_t> pixels,
                  const DrawState& state, Frame& frame);

// What the host does to the frame that it has read back: r, g and b divided by the summed weights in alpha,
// alpha set to 1. Pixels of weight 0 stay as they are. Ren 2002, section 7.
void normalize(Frame& frame);

}  // namespace splatscope::output
