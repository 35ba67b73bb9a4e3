#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/command/commands.h"
#include "model/number/formats.h"
#include "studies/study.h"

// One pixel or one vertex of a trace, step by step: `splatscope explain`.
namespace splatscope::studies {

// What a command did to a pixel.
struct PixelStep {
  using Color = std::array<double, 4>;
  enum class Kind : std::uint8_t { clear, triangle, normalize, present };

  Kind kind = Kind::triangle;
  std::uint32_t command = 0;  // its place in the trace
  // Of a triangle:
  std::uint32_t draw = 0;      // its number among the draws of the trace
  std::uint32_t triangle = 0;  // of the draw, as indexed
  std::uint32_t target = 0;    // 0 the frame, n > 0 the off-screen surface n
  bool passed = false;         // the depth test
  bool writes_color = false;
  Vec4 diffuse{};  // as the pixel unit sees it
  // Of the draw's texture, or of the surface that it samples: as it would be in a frame of floats, and as
  // the combiners take it.
  Vec4 texel{};
  Vec4 source{};  // out of the pixel program, made of these
  // Before and after the step: what the target holds in the machine's format, and what it would hold if
  // blending were exact (in double, and never clamped), there and in the surface that the draw samples.
  Vec4 before{}, after{};
  Color before_in_double{}, after_in_double{};
  double depth = 0;  // of the frame, after a step there: 0 (near) to 1
};

// Every step that reached the pixel, in order. Triangles that do not cover it have none. Throws UserError
// (file "--pixel") where it lies outside of the frame.
std::vector<PixelStep> explain_pixel(const Trace& trace, const NumberFormats& formats, std::uint32_t x,
                                     std::uint32_t y, const Progress& progress = {});

// The same as text, a few lines a step, and a heading for each command.
std::string describe(const Trace& trace, const NumberFormats& formats, const std::vector<PixelStep>& steps);

// The vertex program of vertex `index` of the `draw`-th draw (both from 0; `index` as in the index buffer,
// the draw's base vertex is added), instruction by instruction with what each reads and writes. Throws
// UserError (file "--vertex") where there is no such draw or vertex.
std::string explain_vertex(const Trace& trace, const NumberFormats& formats, std::uint32_t draw,
                           std::uint32_t index);

}  // namespace splatscope::studies
