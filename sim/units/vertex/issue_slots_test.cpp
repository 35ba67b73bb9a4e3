#include "sim/units/vertex/issue_slots.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace splatscope::sim {
namespace {

using isa::Program;

Program program(std::string_view body) {
  return isa::assemble("vs_1_1\n" + std::string(body), "test.vs");
}

// One thread, results at once.
Machine::Vertex plain() {
  return {};
}

Machine::Vertex nv25() {
  return machine::load(machine::kGeForce4).vertex;
}

std::size_t slots(std::string_view body, Machine::Vertex spec) {
  spec.pairing = true;
  return issue_slots(program(body), spec).size();
}

// The slot of each instruction of a program, by its place.
std::vector<std::size_t> slots_by_place(std::string_view body, const Machine::Vertex& spec) {
  const Program text = program(body);
  std::vector<std::size_t> slot_of(text.instructions.size());
  const auto ordered = issue_slots(text, spec);
  for (std::size_t slot = 0; slot < ordered.size(); ++slot)
    for (const int place : ordered[slot].instructions)
      if (place >= 0) slot_of[static_cast<std::size_t>(place)] = slot;
  return slot_of;
}

TEST(IssueSlots, AVectorAndAScalarInstructionPair) {
  EXPECT_EQ(slots("mul r0, v0, c0\nrcp r1.x, r2.x\n", plain()), 1u);
  EXPECT_EQ(slots("rcp r1.x, r2.x\ndp4 r0.x, v0, c0\n", plain()), 1u);
}

TEST(IssueSlots, WhatKeepsTwoFromPairing) {
  EXPECT_EQ(slots("mul r0, v0, c0\nmul r1, v0, c0\n", plain()), 2u);        // both vector
  EXPECT_EQ(slots("rcp r0.x, r2.x\nrsq r1.x, r2.x\n", plain()), 2u);        // both scalar
  EXPECT_EQ(slots("mul r0, v0, c0\nrcp r1.x, r0.x\n", plain()), 2u);        // needs the result
  EXPECT_EQ(slots("add r0, v0, c0\nrcp r1.x, r2.x\n", plain()), 2u);        // third operand port
  EXPECT_EQ(slots("sub r0, v0, c0\nrcp r1.x, r2.x\n", plain()), 2u);        // third operand port
  EXPECT_EQ(slots("mad r0, v0, c0, r3\nrcp r1.x, r2.x\n", plain()), 2u);    // third operand port
  EXPECT_EQ(slots("mul r0, v0, c0\nrcp r1.x, c1.x\n", plain()), 2u);        // two constants
  EXPECT_EQ(slots("mul r0, v0, c[a0.x]\nrcp r1.x, c0.x\n", plain()), 2u);   // two constants, perhaps
  EXPECT_EQ(slots("mul r0, v0, c0\nrcp r1.x, v1.x\n", plain()), 2u);        // two inputs
  EXPECT_EQ(slots("mov oPos, r3\nrcp oD0.w, r2.x\n", plain()), 2u);         // two outputs
  EXPECT_EQ(slots("mul r0.x, v0.x, c0.x\nrcp r0.x, r2.x\n", plain()), 2u);  // the same component
  EXPECT_EQ(slots("mul r0.y, v0.x, c0.x\nrcp r0.x, r2.x\n", plain()), 1u);  // another component
  EXPECT_EQ(slots("mul r0, v0, c0\nrcp r1.x, c0.x\n", plain()), 1u);        // the same constant
  Machine::Vertex without;
  EXPECT_EQ(issue_slots(program("mul r0, v0, c0\nrcp r1.x, r2.x\n"), without).size(), 2u);
}

TEST(IssueSlots, TheDriverBringsIndependentInstructionsTogether) {
  constexpr std::string_view body =
      "mul r0, v0, c0\nmul r1, v0, c0\nrcp r2.x, v0.x\nrcp r3.x, r2.x\nmul r4, r1, r3.x\n";
  Machine::Vertex spec = plain();
  spec.pairing = true;
  EXPECT_EQ(issue_slots(program(body), spec).size(), 4u);
  spec.driver_reorders = true;
  const auto ordered = issue_slots(program(body), spec);
  ASSERT_EQ(ordered.size(), 3u);  // rcp r2 beside a mul, rcp r3 beside the other, the last
  EXPECT_TRUE(ordered[0].has_scalar && ordered[0].has_vector);
  EXPECT_TRUE(ordered[1].has_scalar && ordered[1].has_vector);
  EXPECT_EQ(ordered[2].instructions[0], 4);
}

TEST(IssueSlots, TheDriverKeepsEveryDependence) {
  // r0 is written, read, written again and read again: the two lives must not mix.
  const auto slot_of = slots_by_place(
      "mov r0, v0\nmul r1, r0, c0\nrcp r0.x, v0.x\nmul r2, r1, r0.x\nmov r1, v0\nmul oD0, r1, r2\n", nv25());
  EXPECT_LT(slot_of[0], slot_of[1]);
  EXPECT_LE(slot_of[1], slot_of[2]);  // may share a slot: operands are read before results are written
  EXPECT_LT(slot_of[2], slot_of[3]);
  EXPECT_LE(slot_of[3], slot_of[4]);
  EXPECT_LT(slot_of[4], slot_of[5]);
}

// What is written last stays.
TEST(IssueSlots, TheDriverKeepsTheOrderOfAnOutputsWrites) {
  const std::string start = "mov oPos, v0\nmul r1, v0, c0\nmul oD0, r1, c0\n";
  const auto same = slots_by_place(start + "rcp oD0.w, v0.x\n", nv25()),
             other = slots_by_place(start + "rcp oD1.w, v0.x\n", nv25());
  EXPECT_LT(same[2], same[3]);
  EXPECT_GT(other[2], other[3]) << "an independent one comes first";
}

// Each link of a chain reads what the one before has written; outputs, which cannot be read, are written by
// the last.
TEST(IssueSlots, ChainsThatEndInAnOutputAreChains) {
  for (const std::string name : {"exp", "log", "frc"}) {
    const std::string mask = name == "frc" ? ".xy" : "";
    const auto direct = issue_slots(program(name + " oT0" + mask + ", v0\n"), plain());
    const auto through = issue_slots(program(name + " r0" + mask + ", v0\n"), plain());
    ASSERT_EQ(direct.size(), through.size()) << name;
    for (const auto* slots : {&direct, &through})
      for (std::size_t i = 1; i < slots->size(); ++i)
        EXPECT_EQ((*slots)[i].reads, (*slots)[i - 1].scalar_writes | (*slots)[i - 1].vector_writes) << name;
    EXPECT_NE(direct[0].scalar_writes, 0u) << name;
    EXPECT_EQ(direct.back().vector_writes, 0u) << name;
  }
}

TEST(IssueSlots, AChainReadsWhatItsInstructionReads) {
  EXPECT_EQ(issue_slots(program("frc r2.xy, r1\n"), plain())[0].reads, 0x30u);
  EXPECT_EQ(issue_slots(program("exp r2, r1.z\n"), plain())[0].reads, 0x40u);
}

TEST(IssueSlots, MacrosTakeTheirSlots) {
  const std::tuple<const char*, std::size_t, ComponentMask> macros[] = {{"m4x4 r1, r0, c0\n", 4, 0xf},
                                                                        {"m4x3 r1.xyz, r0, c0\n", 3, 0xf},
                                                                        {"m3x4 r1, r0, c0\n", 4, 0x7},
                                                                        {"m3x3 r1.xyz, r0, c0\n", 3, 0x7},
                                                                        {"m3x2 r1.xy, r0, c0\n", 2, 0x7}};
  for (const auto& [text, rows, reads] : macros) {
    const auto slots = issue_slots(program(text), plain());
    ASSERT_EQ(slots.size(), rows) << text;
    for (std::size_t row = 0; row < rows; ++row) {
      EXPECT_EQ(slots[row].reads, reads) << text;
      EXPECT_EQ(slots[row].vector_writes, ComponentMask{0x10} << row) << text;
    }
  }
  const Program chain = program("exp r0.x, v0.x\n");
  EXPECT_EQ(issue_slots(chain, plain()).size(), static_cast<std::size_t>(isa::slot_count(chain)));
}

// The scalar unit takes an instruction in every third clock; what else is there stands between.
TEST(IssueSlots, TheDriverKeepsScalarInstructionsApart) {
  Machine::Vertex spec = plain();
  spec.driver_reorders = true;
  spec.scalar_interval = 3;
  std::vector<int> order;
  for (const IssueSlot& slot :
       issue_slots(program("rcp r0.x, v0.x\nrcp r1.x, v0.y\nmov r2, v0\nmov r3, v0\n"), spec))
    order.push_back(slot.instructions[0]);
  EXPECT_EQ(order, (std::vector<int>{0, 2, 3, 1}));
}

}  // namespace
}  // namespace splatscope::sim
