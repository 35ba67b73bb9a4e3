#pragma once

#include <array>
#include <cstddef>

#include "model/command/commands.h"
#include "model/number/blend_factor.h"

namespace splatscope::output {

// What a draw leaves of a pixel in a frame buffer of floating-point numbers.
template <class Real>
std::array<Real, 4> blended(const std::array<Real, 4>& source, const std::array<Real, 4>& destination,
                            const DrawState& state) {
  if (!state.blend) return source;
  constexpr std::array<Real, 4> kBlack{};  // no draw can name the factors of a constant colour
  std::array<Real, 4> out;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto factor = [&](BlendFactor of) {
      return blend_factor(of, Real{1}, source, destination, kBlack, c);
    };
    out[c] = source[c] * factor(state.source_factor) + destination[c] * factor(state.destination_factor);
  }
  return out;
}

}  // namespace splatscope::output
