#include "kernels/object_space_ewa/alpha_texture.h"

#include <algorithm>
#include <cmath>

namespace splatscope::kernels {

int optimal_length(double cutoff) {
  const double radius = std::sqrt(2.0 * cutoff);
  const double steepest = std::min(radius, 1.0);  // r exp(-r^2/2) rises up to r = 1
  return static_cast<int>(std::ceil(510.0 * radius * steepest * std::exp(-0.5 * steepest * steepest)));
}

Texture alpha_texture(double cutoff, int length, CutoffShape shape) {
  const double radius = std::sqrt(2.0 * cutoff);
  const auto coordinate = [&](int texel) { return radius * ((2.0 * texel + 1.0) / length - 1.0); };
  Texture texture;
  texture.width = texture.height = static_cast<std::uint32_t>(length);
  texture.texels.reserve(static_cast<std::size_t>(length) * static_cast<std::size_t>(length));
  for (int row = 0; row < length; ++row) {
    for (int column = 0; column < length; ++column) {
      const double squared = coordinate(row) * coordinate(row) + coordinate(column) * coordinate(column);
      const bool inside = shape == CutoffShape::square || squared <= 2.0 * cutoff;
      const double alpha = inside ? std::exp(-0.5 * squared) : 0.0;
      texture.texels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * alpha)));
    }
  }
  return texture;
}

}  // namespace splatscope::kernels
