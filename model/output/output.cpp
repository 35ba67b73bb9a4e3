#include "model/output/output.h"

#include <algorithm>
#include <bit>

#include "model/number/frame_value.h"
#include "model/output/blended.h"

namespace splatscope::output {
namespace {

constexpr double kHalfStep = 0.5;  // rounds to nearest: what does not blend is not dithered

}  // namespace

std::uint32_t quantize_depth(float z, DepthFormat format) {
  const float clamped = saturate(z);
  switch (format) {
    case DepthFormat::z16:
      return static_cast<std::uint32_t>(double{clamped} * 65535.0 + 0.5);
    case DepthFormat::z24:
      return static_cast<std::uint32_t>(double{clamped} * 16777215.0 + 0.5);
    case DepthFormat::float32:
      break;
  }
  return std::bit_cast<std::uint32_t>(clamped);
}

std::uint8_t quantize_unorm8(float value) {
  return static_cast<std::uint8_t>(saturate(value) * 255.0f + 0.5f);
}

void clear(const Clear& command, Frame& frame) {
  Color8 color8;
  for (std::size_t c = 0; c < 4; ++c) color8[c] = quantize_unorm8(command.color[c]);
  std::ranges::fill(frame.colors8, color8);
  Vec4 stored;
  for (std::size_t c = 0; c < 4; ++c)
    stored[c] = stored_value(frame.formats.frame, command.color[c], kHalfStep);
  std::ranges::fill(frame.colors32, stored);
  frame.cleared_depth = quantize_depth(command.depth, frame.formats.depth);
  std::ranges::fill(frame.depth, frame.cleared_depth);
}

namespace {

double offset_at(std::uint32_t pixel, const DrawState& state, const Frame& frame) {
  if (!state.blend) return kHalfStep;
  return rounding_offset(frame.formats.frame_rounding, pixel % frame.width, pixel / frame.width);
}

// What a blend unit takes of a colour: a fixed-point frame buffer clamps it before its factors.
Vec4 source_of(const std::array<const float*, 4>& colors, std::size_t i, FrameFormat format) {
  Vec4 color{colors[0][i], colors[1][i], colors[2][i], colors[3][i]};
  if (format != FrameFormat::float32 && format != FrameFormat::half)
    std::ranges::transform(color, color.begin(), saturate);
  return color;
}

// By packs().
void pack_and_write(const std::array<const float*, 4>& colors, std::span<const std::uint32_t> pixels,
                    const DrawState& state, Frame& frame) {
  constexpr std::size_t kAtOnce = 256;
  alignas(64) std::array<std::uint32_t, kAtOnce> packed;
  for (std::size_t first = 0; first < pixels.size(); first += kAtOnce) {
    const auto some = pixels.subspan(first, std::min(pixels.size() - first, kAtOnce));
    const auto& [r, g, b, a] = colors;
    pack_colors({r + first, g + first, b + first, a + first}, some.size(), state, packed.data());
    write_packed(packed, some, state, frame);
  }
}

}  // namespace

// Factors that need no destination come before those that do.
static_assert(BlendFactor::inv_src_alpha < BlendFactor::dst_alpha);

bool packs(const DrawState& state, const NumberFormats& formats) {
  const bool adds =
      state.destination_factor == BlendFactor::one && state.source_factor <= BlendFactor::inv_src_alpha;
  return formats.frame == FrameFormat::unorm8 &&
         (!state.blend || (adds && formats.frame_rounding == FrameRounding::nearest));
}

void write_colors(const std::array<const float*, 4>& colors, std::span<const std::uint32_t> pixels,
                  const DrawState& state, Frame& frame) {
  const NumberFormats& formats = frame.formats;
  if (packs(state, formats)) return pack_and_write(colors, pixels, state, frame);
  if (formats.frame != FrameFormat::unorm8) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      Vec4& stored = frame.colors32[pixels[i]];
      stored = blended(source_of(colors, i, formats.frame), stored, state);
      if (formats.frame == FrameFormat::float32) continue;
      const double offset = offset_at(pixels[i], state, frame);
      for (float& channel : stored) channel = stored_value(formats.frame, channel, offset);
    }
    return;
  }
  const bool nearest = formats.frame_rounding == FrameRounding::nearest;
  const BlendState blend{state.source_factor, state.destination_factor, BlendEquation::add, {}};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Vec4 color = source_of(colors, i, formats.frame);
    Color8& stored = frame.colors8[pixels[i]];
    if (nearest) {
      Color8 source;
      for (std::size_t c = 0; c < 4; ++c) source[c] = quantize_unorm8(color[c]);
      stored = blend_unorm8(blend, source, stored);
      continue;
    }
    // A source that has been rounded to 8 bits leaves a sum nothing to round: other roundings take it as it
    // comes, and round once.
    const Vec4 sum = blended(color, frame.color(pixels[i]), state);
    const double offset = offset_at(pixels[i], state, frame);
    for (std::size_t c = 0; c < 4; ++c)
      stored[c] = quantize_unorm8(stored_value(FrameFormat::unorm8, sum[c], offset));
  }
}

void normalize(Frame& frame) {
  for (Color8& pixel : frame.colors8) {
    const unsigned weight = pixel[3];
    if (weight == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      pixel[c] = static_cast<std::uint8_t>(std::min(255u, (2 * 255u * pixel[c] + weight) / (2 * weight)));
    }
    pixel[3] = 255;
  }
  for (Vec4& pixel : frame.colors32) {
    if (!(pixel[3] > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = stored_value(frame.formats.frame, pixel[c] / pixel[3], kHalfStep);
    pixel[3] = 1;
  }
}

}  // namespace splatscope::output
