#include "kernels/object_space_ewa/alpha_texture.h"

#include <algorithm>
#include <cmath>

namespace splatscope::kernels {

int optimal_length(double cutoff) {
  const double radius = std::sqrt(2.0 * cutoff);
  const double steepest = std::min(radius, 1.0);  // r exp(-r^2/2) rises up to r = 1
  return static_cast<int>(std::ceil(510.0 * radius * steepest * std::exp(-0.5 * steepest * steepest)));
}

std::uint8_t alpha_texel(double cutoff, CutoffShape shape, double squared_radius) {
  if (shape == CutoffShape::circle && squared_radius > 2.0 * cutoff) return 0;
  return static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-0.5 * squared_radius)));
}

Texture alpha_texture(double cutoff, int length, CutoffShape shape) {
  const double radius = std::sqrt(2.0 * cutoff);
  const auto squared = [&](int texel) {
    const double coordinate = radius * ((2.0 * texel + 1.0) / length - 1.0);
    return coordinate * coordinate;
  };
  Texture texture;
  texture.width = texture.height = static_cast<std::uint32_t>(length);
  texture.texels.reserve(static_cast<std::size_t>(length) * static_cast<std::size_t>(length));
  for (int row = 0; row < length; ++row) {
    for (int column = 0; column < length; ++column) {
      texture.texels.push_back(alpha_texel(cutoff, shape, squared(row) + squared(column)));
    }
  }
  return texture;
}

}  // namespace splatscope::kernels
