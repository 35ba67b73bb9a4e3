#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "model/pixel/pixel_program.h"

// The registers of a batch of fragments while a program runs. Internal to model/pixel.
namespace splatscope::pixel {

// Into the range of a register, which has 0 in it. NaN counts as 0: the registers of the hardware are
// fixed-point and hold none.
inline float in_range(float value, float low, float high) {
  const float number = std::isnan(value) ? 0.0f : value;
  return std::min(std::max(number, low), high);
}

// in_range of each lane.
void clamp_lanes(const float* from, float low, float high, float* to, int count);

// value*scale + offset of each lane.
void scale_lanes(const float* from, float scale, float offset, float* to, int count);

struct alignas(64) Register {
  Lanes component[4];
};

// Four components each; those that a run need not keep apart are the batch's own.
struct Registers {
  std::array<Lanes*, kStages> temporaries;  // r0 is the batch's
  std::array<Lanes*, 2> inputs;
  std::array<Lanes*, kStages> textures;  // t#: up to ps_1_3 what texture instructions made of them, in ps_1_4
                                         // the coordinates
  Register constants[8];
  Lanes rows[3];  // of texm3x2* and texm3x3*
  int row = 0;    // of them, how many there are

  Register own_temporaries[kStages], own_inputs[2], own_textures[kStages];
};

// Its four components.
Lanes* register_of(Registers& registers, isa::RegisterFile file, std::size_t index);

// What a run has besides its registers.
struct Context {
  const isa::Version version;
  FragmentBatch& batch;
  int count;
  const Sampler& sampler;
  const BumpStages& bump;
  bool sampled_ahead = false;  // t# holds the texels already
};

// Four components to read: of a register itself, or of a copy that a modifier made.
struct Operand {
  std::array<const float*, 4> component{};
};

Operand read(const isa::Source& source, Registers& registers, Register& copy, int count);

// The range of results, and whether they are rounded to steps of 1/255.
struct ResultFormat {
  float low, high;
  bool steps;
};

// An arithmetic instruction with its operands found.
struct Operation {
  isa::Opcode opcode;
  unsigned mask;         // of the components that are computed
  bool select_by_alpha;  // cnd looks at alpha alone
  std::array<Operand, 3> sources;
  const float (*bump)[2];  // of bem
  float scale;             // of the result
  ResultFormat format;     // of the scaled result
};

// The result as the register holds it, in the components of the mask. `result` is none of the sources.
void compute_lanes(const Operation& operation, int count, Lanes* result);

// One texture address instruction (texture_instructions.cpp).
void run_texture_instruction(const isa::Instruction& instruction, Registers& registers,
                             const Context& context);

}  // namespace splatscope::pixel
