#include "model/output/frame.h"

#include <bit>

namespace splatscope {

Frame::Frame(std::uint32_t frame_width, std::uint32_t frame_height, const NumberFormats& number_formats)
    : width(frame_width), height(frame_height), formats(number_formats) {
  const std::size_t pixels = std::size_t{width} * height;
  if (formats.frame == FrameFormat::unorm8) {
    colors8.resize(pixels);
  } else {
    colors32.resize(pixels);
  }
  depth.resize(pixels);
}

Vec4 Frame::color(std::size_t pixel) const {
  if (formats.frame != FrameFormat::unorm8) return colors32[pixel];
  Vec4 color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = static_cast<float>(colors8[pixel][c]) / 255.0f;
  return color;
}

double Frame::depth_value(std::size_t pixel) const {
  switch (formats.depth) {
    case DepthFormat::z16:
      return depth[pixel] / 65535.0;
    case DepthFormat::z24:
      return depth[pixel] / 16777215.0;
    case DepthFormat::float32:
      break;
  }
  return std::bit_cast<float>(depth[pixel]);
}

}  // namespace splatscope
