#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "model/command/commands.h"
#include "model/output/frame.h"

namespace splatscope::texture {

// The texels nearest to (u, v) of fragments 0..alpha.size()-1, texture coordinates in [0, 1] from the first
// texel's outer corner; clamped to the edge, NaN counts as 0. What lies behind in `u` and `v`, up to a
// multiple of 16, is read and ignored. `alpha`: 0 to 1. `blocks` (where not empty): kTexelBlockEdge^2 texels
// each, numbered by rows of blocks.
void sample_nearest(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
                    std::span<std::uint32_t> blocks);

// The alpha between the four texels about (u, v), with weights rounded to `weight_bits` fraction bits, 1
// to 8.
void sample_bilinear(const Texture& texture, int weight_bits, const float* u, const float* v,
                     std::span<float> alpha);

// All channels of the pixels of a surface nearest to (u, v) of fragments 0..blocks.size()-1, as above.
// `color`: r, g, b and a. `blocks`: of 16 bytes; a surface lies in memory in tiles of 4x4 pixels, by rows of
// tiles, and a tile in quads of 2x2 pixels.
void sample_surface(const Frame& surface, const float* u, const float* v, const std::array<float*, 4>& color,
                    std::span<std::uint32_t> blocks);

}  // namespace splatscope::texture
