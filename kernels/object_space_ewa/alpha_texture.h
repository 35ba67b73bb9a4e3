#pragma once

#include "model/command/commands.h"

namespace splatscope::kernels {

// Where the filter ends (Ren 2002, section 5.2): at the parallelogram that encodes it, or at y.y <= 2c, the
// ellipse in it.
enum class CutoffShape : std::uint8_t { square, circle };

// Eq. 16: the smallest len at which neighbouring texels differ by at most one step of 8 bits. c > 0; 438 for
// c = 1.
int optimal_length(double cutoff);

// A texel whose centre is at y, in 8 bits rounded to nearest: exp(-y.y/2), and 0 beyond the cutoff.
std::uint8_t alpha_texel(double cutoff, CutoffShape shape, double squared_radius);

// g(y) = exp(-y.y/2) over [-sqrt(2c), sqrt(2c)]^2 at length x length texel centres, in 8 bits (or `bits`, 1
// to 16), rounded to nearest; 0 beyond the cutoff. c > 0, length from 1 to 4096.
Texture alpha_texture(double cutoff, int length, CutoffShape shape, int bits = 8);

}  // namespace splatscope::kernels
