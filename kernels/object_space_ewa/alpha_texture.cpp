#include "kernels/object_space_ewa/alpha_texture.h"

#include <algorithm>
#include <cmath>

namespace splatscope::kernels {

int optimal_length(double cutoff) {
  const double radius = std::sqrt(2.0 * cutoff);
  const double steepest = std::min(radius, 1.0);  // r exp(-r^2/2) rises up to r = 1
  return static_cast<int>(std::ceil(510.0 * radius * steepest * std::exp(-0.5 * steepest * steepest)));
}

namespace {

long texel_of(double cutoff, CutoffShape shape, double squared_radius, int bits) {
  if (shape == CutoffShape::circle && squared_radius > 2.0 * cutoff) return 0;
  return std::lround(((1 << bits) - 1) * std::exp(-0.5 * squared_radius));
}

}  // namespace

std::uint8_t alpha_texel(double cutoff, CutoffShape shape, double squared_radius) {
  return static_cast<std::uint8_t>(texel_of(cutoff, shape, squared_radius, 8));
}

Texture alpha_texture(double cutoff, int length, CutoffShape shape, int bits) {
  const double radius = std::sqrt(2.0 * cutoff);
  const auto squared = [&](int texel) {
    const double coordinate = radius * ((2.0 * texel + 1.0) / length - 1.0);
    return coordinate * coordinate;
  };
  Texture texture;
  texture.width = texture.height = static_cast<std::uint32_t>(length);
  texture.bits = bits;
  texture.texels.reserve(static_cast<std::size_t>(length) * static_cast<std::size_t>(length) *
                         (bits > 8 ? 2 : 1));
  for (int row = 0; row < length; ++row) {
    for (int column = 0; column < length; ++column) {
      const long texel = texel_of(cutoff, shape, squared(row) + squared(column), bits);
      texture.texels.push_back(static_cast<std::uint8_t>(texel & 0xff));
      if (bits > 8) texture.texels.push_back(static_cast<std::uint8_t>(texel >> 8));
    }
  }
  return texture;
}

}  // namespace splatscope::kernels
