#pragma once

#include <cstdint>

namespace splatscope {

// Arithmetic of the vertex unit: IEEE binary32, or what the NV20 does (docs/nv20_arithmetic.md).
enum class Arithmetic : std::uint8_t { ieee, nv20 };

// Frame buffer, a channel: 8 bits, or binary32 (for proofs against a reference); and what no machine of 2002
// blended into: 10 and 16 bits, and binary16.
enum class FrameFormat : std::uint8_t { unorm8, float32, unorm10, unorm16, half };

// How a blended colour becomes the whole steps of a UNORM frame buffer: to the nearest, down, or by an
// ordered 4x4 dither.
enum class FrameRounding : std::uint8_t { nearest, truncate, dither };

// Interpolated colours as the pixel unit sees them.
enum class ColorFormat : std::uint8_t { unorm8, float32, unorm12 };

// Results in the pixel unit: binary32 within the version's range; the 9-bit signed steps (1/255) of the
// combiners of 2002; or binary32 without a range (to compare with implementations that have none;
// no machine has it).
enum class CombinerFormat : std::uint8_t { float32, signed9, unbounded };

enum class DepthFormat : std::uint8_t { z16, z24, float32 };

// Every lossy step of the machine, each one switchable. The defaults are the machines of 2002.
struct NumberFormats {
  Arithmetic vertex_arithmetic = Arithmetic::ieee;
  ColorFormat color = ColorFormat::unorm8;
  CombinerFormat combiner = CombinerFormat::float32;
  FrameFormat frame = FrameFormat::unorm8;
  FrameRounding frame_rounding = FrameRounding::nearest;
  DepthFormat depth = DepthFormat::z24;
  int subpixel_bits = 4;     // of window x and y, 0 to 8: coverage is decided on this grid
  int filter_bits = 0;       // of the weights of bilinear texture filtering, 1 to 8; 0: the nearest texel
  int reciprocal_bits = 24;  // significant bits of RCP and RSQ, 8 to 24: results are rounded to nearest

  bool operator==(const NumberFormats&) const = default;
};

}  // namespace splatscope
