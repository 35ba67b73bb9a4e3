#pragma once

#include <array>
#include <cstdint>

// What the blend unit computes on an 8-bit frame buffer.
namespace splatscope {

// The factors of Direct3D 8, then four of a constant colour, which no trace names: the oracle's vectors do.
enum class BlendFactor : std::uint8_t {
  zero,
  one,
  src_color,
  inv_src_color,
  src_alpha,
  inv_src_alpha,
  dst_alpha,
  inv_dst_alpha,
  dst_color,
  inv_dst_color,
  src_alpha_saturate,
  constant_color,
  inv_constant_color,
  constant_alpha,
  inv_constant_alpha
};

// min and max ignore the factors. Draws of a trace add: the others too are the oracle's vectors' alone.
enum class BlendEquation : std::uint8_t { add, subtract, reverse_subtract, min, max };

using Color8 = std::array<std::uint8_t, 4>;  // r g b a, 255 is 1

struct BlendState {
  BlendFactor source_factor = BlendFactor::one;
  BlendFactor destination_factor = BlendFactor::zero;
  BlendEquation equation = BlendEquation::add;
  Color8 constant{};
};

// out = clamp(floor((2*(src*sf OP dst*df) + 255) / 510)): one rounding to nearest of the exact sum over 255,
// with 8-bit factors where 1 - f is 255 - f (read off the screens of an NV2A: tests/oracle/blend.json).
Color8 blend_unorm8(const BlendState& state, Color8 source, Color8 destination);

}  // namespace splatscope
