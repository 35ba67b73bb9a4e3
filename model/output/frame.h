#pragma once

#include <cstdint>
#include <vector>

#include "model/command/commands.h"
#include "model/number/blend.h"
#include "model/number/formats.h"

// The frame and depth buffers, and what is written to them.
namespace splatscope {

// Row-major from the top left, width*height pixels. `colors8` is filled where the frame format is
// unorm8, else `colors32`, with what the format can hold.
struct Frame {
  std::uint32_t width = 0, height = 0;
  NumberFormats formats;
  std::vector<Color8> colors8;  // r g b a
  std::vector<Vec4> colors32;   // r g b a
  std::vector<std::uint32_t>
      depth;  // z16/z24: 0..2^bits-1; float32: the bits of a float in [0, 1], which order alike
  std::uint32_t cleared_depth = 0;  // by the last clear

  Frame(std::uint32_t width, std::uint32_t height, const NumberFormats& formats);

  // Colour of a pixel as floats, 8-bit values divided by 255.
  Vec4 color(std::size_t pixel) const;
  // Depth of a pixel, 0 to 1.
  double depth_value(std::size_t pixel) const;

  bool operator==(const Frame&) const = default;
};

}  // namespace splatscope
