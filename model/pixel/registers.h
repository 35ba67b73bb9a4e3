#pragma once

#include <array>
#include <cstddef>

#include "model/pixel/pixel_program.h"

// The registers of a batch of fragments while a program runs. Internal to model/pixel.
namespace splatscope::pixel {

struct alignas(64) Register {
  Lanes component[4];
};

struct Registers {
  Register temporaries[kStages];
  Register constants[8];
  Register inputs[2];
  Register textures[kStages];  // t#: up to ps_1_3 what texture instructions made of them, in ps_1_4 the
                               // coordinates
  Lanes rows[3];               // of texm3x2* and texm3x3*
  int row = 0;                 // of them, how many there are
};

Register& register_of(Registers& registers, isa::RegisterFile file, std::size_t index);

// What a run has besides its registers.
struct Context {
  const isa::Version version;
  FragmentBatch& batch;
  int count;
  const Sampler& sampler;
  const BumpStages& bump;
};

// Four components to read: of a register itself, or of a copy that a modifier made.
struct Operand {
  std::array<const float*, 4> component{};
};

Operand read(const isa::Source& source, Registers& registers, Register& copy, int count);

// One texture address instruction (texture_instructions.cpp).
void run_texture_instruction(const isa::Instruction& instruction, Registers& registers,
                             const Context& context);

}  // namespace splatscope::pixel
