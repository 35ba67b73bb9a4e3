#pragma once

#include <memory>
#include <span>

#include "model/command/commands.h"
#include "model/isa/program.h"
#include "model/number/formats.h"

namespace splatscope::pixel {

inline constexpr int kBatch = 64;  // fragments executed together

// Registers of a batch of fragments, structure of arrays: [component r g b a][fragment].
struct FragmentBatch {
  alignas(64) float v0[4][kBatch];    // interpolated diffuse, in [0, 1]
  alignas(64) float v1[4][kBatch];    // interpolated specular
  alignas(64) float t[4][4][kBatch];  // texture coordinates in; where `sampled`, the texel of that stage
  alignas(64) float r0[4][kBatch];    // result
};

// A ps_1_x program made ready to run. Without `tex` instructions' own sampling: the caller samples stage n at
// the coordinates t[n] for every stage in texture_stages() before run() and stores the texel in t[n].
class PixelProgram {
 public:
  explicit PixelProgram(const isa::Program& program);
  ~PixelProgram();
  PixelProgram(PixelProgram&&) noexcept;
  PixelProgram& operator=(PixelProgram&&) noexcept;

  unsigned texture_stages() const;  // bit n: stage n is sampled (`tex tn`)
  void run(std::span<const Vec4> constants, FragmentBatch& batch, int count) const;

 private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
};

}  // namespace splatscope::pixel
