#pragma once

#include <array>
#include <bitset>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/isa/program.h"
#include "model/number/formats.h"

namespace splatscope::pixel {

inline constexpr int kBatch = 256;  // fragments executed together
inline constexpr int kStages = 6;   // texture stages and coordinate sets: 4 up to ps_1_3

inline constexpr int kLaneStride = kBatch + 16;  // with room behind for a whole SIMD register
using Lanes = float[kLaneStride];

// Registers of a batch of fragments, structure of arrays: [component r g b a][fragment].
struct FragmentBatch {
  alignas(64) Lanes v0[4];          // interpolated diffuse, in [0, 1]
  alignas(64) Lanes v1[4];          // interpolated specular, the same
  alignas(64) Lanes t[kStages][4];  // texture coordinates
  alignas(64) Lanes r0[4];          // result
  alignas(64) Lanes depth;          // result of texdepth and texm3x2depth, where writes_depth()
  std::bitset<kBatch> killed;       // result: bit i where texkill cancelled fragment i
};

// Samples the texture of a stage at coordinates u v w (u, v for a 2D one) of fragments 0..count-1.
using Sampler = std::function<void(int stage, const Lanes* coordinates, Lanes* texel, int count)>;

// Texture-stage state of the bump instructions (D3DTSS_BUMPENVMAT, BUMPENVLSCALE, BUMPENVLOFFSET).
struct BumpStage {
  float matrix[2][2] = {{0, 0}, {0, 0}};
  float luminance_scale = 0;
  float luminance_offset = 0;
};
using BumpStages = std::array<BumpStage, kStages>;

// Registers of one fragment between two instructions.
struct FragmentState {
  std::array<Vec4, kStages> temporaries{};
  std::array<Vec4, kStages> textures{};  // t#
  float depth = 0;                       // of texdepth and texm3x2depth
};

// A ps_1_1 to ps_1_4 program made ready to run. Registers keep to their ranges: c# in [-1, 1], v# in [0, 1],
// results of arithmetic in [-1, 1] up to ps_1_3 and [-8, 8] in ps_1_4 (Direct3D 8.1 reference, "Registers -
// ps_1_X"). NaN counts as 0 there, so r0 never holds one.
class PixelProgram {
 public:
  // `program` is valid (isa::validate): it reads no temporary before it writes it, and writes all of r0.
  explicit PixelProgram(const isa::Program& program, CombinerFormat format = CombinerFormat::float32);
  ~PixelProgram();
  PixelProgram(PixelProgram&&) noexcept;

  unsigned texture_stages() const;  // bit n: stage n is sampled
  bool writes_depth() const;

  // Whether every stage is sampled at its own coordinates, which nothing else reads, and the program kills no
  // fragment and writes no depth. Then textures can be sampled ahead.
  bool samples_ahead() const;

  // Where samples_ahead(): the caller has replaced t[n] by the texel of stage n for every stage in
  // texture_stages(), and v0 and v1 are in their range.
  void run(std::span<const Vec4> constants, FragmentBatch& batch, int count) const;

  // Any program, which samples as it runs; v0 and v1 are brought into their range.
  void run(std::span<const Vec4> constants, FragmentBatch& batch, int count, const Sampler& sampler,
           const BumpStages& bump = {}) const;

  // Fragment 0 instruction by instruction: its registers before the first one and after each; the halves of a
  // co-issued pair write together. The batch gets the results of run().
  std::vector<FragmentState> trace(std::span<const Vec4> constants, FragmentBatch& batch,
                                   const Sampler& sampler, const BumpStages& bump = {}) const;

 private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
};

}  // namespace splatscope::pixel
