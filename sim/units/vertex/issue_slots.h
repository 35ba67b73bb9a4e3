#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/isa/program.h"
#include "model/machine/machine.h"

// A vertex program as a unit issues it.
namespace splatscope::sim {

// Register components that an instruction reads or writes: bit 4r + c is component c of temporary r, 48 is
// a0.x, and 52 what lies between the parts of an instruction of several slots that writes an output.
using ComponentMask = std::uint64_t;
inline constexpr int kRegisters = 14;

// What issues in one slot: an instruction, or a vector and a scalar one side by side.
struct IssueSlot {
  ComponentMask reads = 0;
  ComponentMask vector_writes = 0;
  ComponentMask scalar_writes = 0;
  bool has_vector = false;
  bool has_scalar = false;
  std::array<int, 2> instructions{-1, -1};  // their places in the program; -1: there is no second
};

// The slots of a program, macros expanded: in its order, or (`vertex.driver_reorders`) by list scheduling,
// the longest chain first. Two, neighbours or where reordered any two that are ready, share a slot where the
// unit pairs (`vertex.pairing`) and: one is a vector and one a scalar instruction, and none a nop; neither
// needs the other's result, nor writes a component of it; together they read at most one constant and one
// input register; the vector one leaves the third operand port free (it is not add, sub or mad); at most one
// of them writes an output register.
std::vector<IssueSlot> issue_slots(const isa::Program& program, const Machine::Vertex& spec);

}  // namespace splatscope::sim
