#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "model/command/commands.h"
#include "model/work/work.h"

namespace splatscope::texture {

// The texels nearest to (u, v) of fragments 0..alpha.size()-1, texture coordinates in [0, 1] from the first
// texel's outer corner; clamped to the edge, NaN counts as 0. `alpha`: 0 to 1. `blocks` (where not empty):
// kTexelBlockEdge^2 texels each, numbered by rows of blocks.
void sample_nearest(const Texture& texture, const float* u, const float* v, std::span<float> alpha,
                    std::span<std::uint32_t> blocks);

// The alpha between the four texels about (u, v), with weights rounded to `weight_bits` fraction bits, 1
// to 8.
void sample_bilinear(const Texture& texture, int weight_bits, const float* u, const float* v,
                     std::span<float> alpha);

}  // namespace splatscope::texture
