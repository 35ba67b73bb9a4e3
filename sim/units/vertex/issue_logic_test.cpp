#include "sim/units/vertex/issue_logic.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "model/error.h"
#include "model/machine/machine.h"
#include "sim/units/vertex/vertex_clocks.h"

namespace splatscope::sim {
namespace {

using Ends = std::vector<std::pair<Cycle, int>>;  // cycle of a vertex's last slot, its thread

Machine::Vertex unit_of(int threads, int reload_cycles) {
  Machine::Vertex spec;
  spec.threads = threads;
  spec.vector_latency = 3;
  spec.scalar_latency = 3;
  spec.scalar_interval = 2;
  spec.reload_cycles = reload_cycles;
  return spec;
}

isa::Program program_of(const std::string& text) {
  return isa::load("vs.1.1\n" + text, "test");
}

const char* const kTransform =
    "dp4 oPos.x, v0, c0\n"
    "dp4 oPos.y, v0, c1\n"
    "dp4 oPos.z, v0, c2\n"
    "dp4 oPos.w, v0, c3\n";

// The first `count` ends of a stream that never waits; the first vertex is taken before cycle 0, one at most
// in every cycle after that.
Ends ends_of(const std::string& text, const Machine::Vertex& spec, std::size_t count) {
  const auto slots = issue_slots(program_of(text), spec);
  IssueLogic logic(slots, spec);
  logic.take();
  Ends ends;
  for (Cycle now = 0; ends.size() < count; ++now) {
    if (const auto issued = logic.issue(); issued && issued->is_last) ends.emplace_back(now, issued->thread);
    if (logic.next_free() == 0) logic.take();
  }
  return ends;
}

TEST(IssueLogic, RefusesLatenciesThatItCannotCount) {
  Machine::Vertex spec = unit_of(1, 254);
  const std::vector<IssueSlot> slots = issue_slots(program_of(kTransform), spec);
  EXPECT_NO_THROW(IssueLogic(slots, spec));
  spec.scalar_latency = 255;
  EXPECT_THROW(IssueLogic(slots, spec), ModelError);
}

// The threads issue in turn: 0 1 2, 0 1 2, ... then nothing in cycle 12, as thread 0 issued last in 9 and is
// reloaded in 10, 11 and 12.
TEST(IssueLogic, ThreeThreadsOfFourSlotsTakeTurns) {
  EXPECT_EQ(ends_of(kTransform, unit_of(3, 3), 6),
            (Ends{{9, 0}, {10, 1}, {11, 2}, {22, 0}, {23, 1}, {24, 2}}));
}

TEST(IssueLogic, OneThreadWithoutReloadingIssuesInEveryCycle) {
  EXPECT_EQ(ends_of(kTransform, unit_of(1, 0), 3), (Ends{{3, 0}, {7, 0}, {11, 0}}));
}

TEST(IssueLogic, WaitsForAnOperand) {
  // Issue in 0, 3, 6; a second thread fills the clocks between: 1, 4, 7.
  const std::string chain = "add r0, v0, c0\nadd r0, r0, c0\nmov oPos, r0\n";
  EXPECT_EQ(ends_of(chain, unit_of(1, 0), 2), (Ends{{6, 0}, {13, 0}}));
  EXPECT_EQ(ends_of(chain, unit_of(2, 0), 2), (Ends{{6, 0}, {7, 1}}));
}

TEST(IssueLogic, OneScalarInstructionInTwoClocks) {
  // Thread 0 issues its RCP in 0; thread 1's has to wait for cycle 2; moves in 3 and 5.
  const std::string reciprocal = "rcp r0.x, c0.x\nmov oPos, r0.x\n";
  EXPECT_EQ(ends_of(reciprocal, unit_of(2, 8), 2), (Ends{{3, 0}, {5, 1}}));
}

TEST(IssueLogic, AShortResultDoesNotOvertakeALongOne) {
  // r0.x: RSQ in 0, there in 9. MOV may write it in 8 at the earliest, to be there in 9; oPos in 9.
  Machine::Vertex spec = unit_of(1, 0);
  spec.vector_latency = 1;
  spec.scalar_latency = 9;
  EXPECT_EQ(ends_of("rsq r0.x, c0.x\nmov r0.x, c1\nmov oPos, r0.x\n", spec, 1), (Ends{{9, 0}}));
}

TEST(IssueLogic, ResultsComeAfterTheLastSlot) {
  Machine::Vertex spec = unit_of(1, 0);
  spec.scalar_latency = 9;
  const auto slots = issue_slots(program_of("rsq r0.x, c0.x\nmov oPos, c0\n"), spec);
  IssueLogic logic(slots, spec);
  logic.take();
  const auto first = logic.issue();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->slot, 0u);
  EXPECT_FALSE(first->is_last);
  const auto last = logic.issue();  // in cycle 1; the RSQ of cycle 0 takes until 9
  ASSERT_TRUE(last);
  EXPECT_TRUE(last->is_last);
  EXPECT_EQ(last->result, 8u);
  EXPECT_EQ(logic.next_free(), 0u);
}

TEST(IssueLogic, NoMoreVerticesThanThreads) {
  const Machine::Vertex spec = unit_of(2, 0);
  const auto slots = issue_slots(program_of(kTransform), spec);
  IssueLogic logic(slots, spec);
  EXPECT_TRUE(logic.is_at_rest());
  EXPECT_EQ(logic.take(), 0);
  EXPECT_EQ(logic.take(), 1);
  EXPECT_EQ(logic.next_free(), kNever);
  EXPECT_THROW(logic.take(), ModelError);
}

// NVIDIA's 125 M vertices a second of two units at 275 MHz are 4.4.
TEST(Throughput, TransformOnTheGeforce4) {
  EXPECT_DOUBLE_EQ(clocks_per_vertex(program_of(kTransform), machine::load(machine::kGeForce4).vertex),
                   13.0 / 3);
}

TEST(Throughput, TransformOnTheRadeon) {
  EXPECT_DOUBLE_EQ(clocks_per_vertex(program_of(kTransform), machine::load(machine::kRadeon8500).vertex), 4);
}

TEST(Throughput, SaysWhichSlotWaits) {
  const auto slots = issue_slots(program_of("add r0, v0, c0\nadd r0, r0, c0\nmov oPos, r0\n"), unit_of(1, 4));
  const Throughput steady = throughput(slots, unit_of(1, 4));
  EXPECT_DOUBLE_EQ(steady.clocks_per_vertex, 11);
  EXPECT_EQ(steady.waits, (std::vector<double>{4, 2, 2}));
}

// Two slots a vertex, of which the scalar unit takes one every `scalar_interval` clocks. Four threads in step
// would issue RCP in 0, 2, 4, 6 and MOV in 3, 5, 7, 9: 2.5 clocks a vertex.
TEST(Throughput, ThreadsSpreadOutOverTheScalarUnit) {
  const isa::Program program = program_of("rcp r0.x, c0.x\nmov oPos, r0.x\n");
  Machine::Vertex spec = unit_of(4, 0);
  EXPECT_DOUBLE_EQ(clocks_per_vertex(program, spec), 2);
  spec.scalar_interval = 5;
  EXPECT_DOUBLE_EQ(clocks_per_vertex(program, spec), 5);
}

// Two a thread, which leave a long pipeline one after the other. Three threads issue in turn, so that a
// vertex issues in clocks 1, 4 and 7.
TEST(Throughput, NoMoreVerticesAreOnTheirWayThanTheUnitHolds) {
  const isa::Program program = program_of("mov oPos, v0\nmov oD0, v1\nmov oT0, v2\n");
  Machine::Vertex spec = unit_of(1, 0);
  spec.vector_latency = 64;
  EXPECT_DOUBLE_EQ(clocks_per_vertex(program, spec), (3.0 + 64) / 2);
  spec.threads = 3;
  EXPECT_DOUBLE_EQ(clocks_per_vertex(program, spec), (7.0 + 64) / 6);
}

// r0.x: MOV in 0, there in 9. RSQ may write it in 8 at the earliest, to be there in 9; oPos in 9.
TEST(IssueLogic, AShortScalarResultDoesNotOvertakeALongOne) {
  Machine::Vertex spec = unit_of(1, 0);
  spec.vector_latency = 9;
  spec.scalar_latency = 1;
  EXPECT_EQ(ends_of("mov r0.x, c1\nrsq r0.x, c0.x\nmov oPos, r0.x\n", spec, 1), (Ends{{9, 0}}));
}

}  // namespace
}  // namespace splatscope::sim
