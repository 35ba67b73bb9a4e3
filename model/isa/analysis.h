#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/isa/program.h"

// What can be said of a program without running it. A program has no branches: each fact is one pass over it.
namespace splatscope::isa {

// Register components: r0..r11, a0, t0..t5, the outputs (register_bit), then the row of a texture matrix that
// a stage of a pixel program gives the last one.
inline constexpr std::size_t kFirstRow = std::size_t{4} * (12 + 1 + 6 + 13);
inline constexpr std::size_t kRegisterBits = kFirstRow + 4;
using RegisterSet = std::bitset<kRegisterBits>;

std::size_t register_bit(RegisterFile file, std::size_t index, std::size_t component);

// "r0.xyz r3 a0.x": the temporaries, address and texture registers of a set.
std::string to_string(const RegisterSet& set);

// What an instruction reads and writes of them, and whether it acts on more than registers (texkill, depth).
struct Effects {
  RegisterSet reads;
  RegisterSet writes;
  bool side_effect = false;
};
Effects effects_of(const Program& program, const Instruction& instruction);

struct InstructionAnalysis {
  bool dead = false;       // nothing that the program outputs depends on it
  RegisterSet live_after;  // components that a later instruction (or the result) still reads
  int finish = 0;          // slots on the longest chain of dependent instructions that ends with it
};

struct Analysis {
  std::vector<InstructionAnalysis> instructions;
  std::vector<std::size_t> critical_path;  // the longest chain: places of its instructions, in order
  int critical_slots = 0;
  int most_live_temporaries = 0;  // registers r# with a live component, at most
};

Analysis analyze(const Program& program);

// Of each instruction, whether its result can depend on one of the given vertex inputs (bit i: v<i>).
std::vector<bool> dependent_on(const Program& program, std::uint32_t inputs);

}  // namespace splatscope::isa
