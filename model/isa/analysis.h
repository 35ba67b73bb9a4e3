#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/isa/program.h"

// What can be said of a program without running it. A program has no branches: each fact is one pass over it.
namespace splatscope::isa {

// Register components: r0..r11, a0, t0..t5, the outputs, then the rows of a texture matrix.
inline constexpr std::size_t kRegisterBits = std::size_t{4} * (12 + 1 + 6 + 13 + 1);
using RegisterSet = std::bitset<kRegisterBits>;

// "r0.xyz r3 a0.x": the temporaries, address and texture registers of a set.
std::string to_string(const RegisterSet& set);

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

// Of a program that validate() finds right.
Analysis analyze(const Program& program);

// Of each instruction, whether its result can depend on one of the given vertex inputs (bit i: v<i>).
std::vector<bool> dependent_on(const Program& program, std::uint32_t inputs);

}  // namespace splatscope::isa
