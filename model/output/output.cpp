#include "model/output/output.h"

#include <algorithm>
#include <bit>

namespace splatscope::output {
namespace {

// The factor of one channel in a float frame buffer.
float factor_of(BlendFactor factor, const Vec4& source, const Vec4& destination, std::size_t channel) {
  switch (factor) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return 1;
    case BlendFactor::src_color:
      return source[channel];
    case BlendFactor::inv_src_color:
      return 1 - source[channel];
    case BlendFactor::src_alpha:
      return source[3];
    case BlendFactor::inv_src_alpha:
      return 1 - source[3];
    case BlendFactor::dst_alpha:
      return destination[3];
    case BlendFactor::inv_dst_alpha:
      return 1 - destination[3];
    case BlendFactor::dst_color:
      return destination[channel];
    case BlendFactor::inv_dst_color:
      return 1 - destination[channel];
    case BlendFactor::src_alpha_saturate:
      return channel == 3 ? 1 : std::min(source[3], 1 - destination[3]);
    default:  // no draw can name the factors of a constant colour
      return 0;
  }
}

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
  std::ranges::fill(frame.colors32, command.color);
  std::ranges::fill(frame.depth, quantize_depth(command.depth, frame.formats.depth));
}

bool test_depth(std::uint32_t depth, std::size_t pixel, const DrawState& state, Frame& frame) {
  if (state.depth_test && depth > frame.depth[pixel]) return false;
  if (state.depth_write) frame.depth[pixel] = depth;
  return true;
}

void write_color(const Vec4& color, std::size_t pixel, const DrawState& state, Frame& frame) {
  if (frame.formats.frame == FrameFormat::unorm8) {
    Color8 source;
    for (std::size_t c = 0; c < 4; ++c) source[c] = quantize_unorm8(color[c]);
    Color8& destination = frame.colors8[pixel];
    if (!state.blend) {
      destination = source;
    } else if (state.destination_factor == BlendFactor::one &&
               (state.source_factor == BlendFactor::src_alpha || state.source_factor == BlendFactor::one)) {
      // What splatting blends with: a whole destination under one rounding is added as it is.
      const int factor = state.source_factor == BlendFactor::one ? 255 : source[3];
      for (std::size_t c = 0; c < 4; ++c) {
        destination[c] =
            static_cast<std::uint8_t>(std::min(255, destination[c] + (2 * source[c] * factor + 255) / 510));
      }
    } else {
      const BlendState blend{state.source_factor, state.destination_factor, BlendEquation::add, {}};
      destination = blend_unorm8(blend, source, destination);
    }
    return;
  }
  Vec4& stored = frame.colors32[pixel];
  if (!state.blend) {
    stored = color;
    return;
  }
  const Vec4 destination = stored;
  for (std::size_t c = 0; c < 4; ++c) {
    stored[c] = color[c] * factor_of(state.source_factor, color, destination, c) +
                destination[c] * factor_of(state.destination_factor, color, destination, c);
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
    for (std::size_t c = 0; c < 3; ++c) pixel[c] /= pixel[3];
    pixel[3] = 1;
  }
}

}  // namespace splatscope::output
