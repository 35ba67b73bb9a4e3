#include "sim/units/vertex/issue_replay.h"

#include <gtest/gtest.h>

#include <random>

#include "model/testing/random_seed.h"

namespace splatscope::sim {
namespace {

Machine::Vertex three_threads() {
  Machine::Vertex spec;
  spec.threads = 3;
  spec.vector_latency = 3;
  spec.scalar_latency = 5;
  spec.scalar_interval = 2;
  spec.reload_cycles = 3;
  return spec;
}

// A chain in which every third slot is scalar.
std::vector<IssueSlot> chain(std::size_t count) {
  std::vector<IssueSlot> slots(count);
  for (std::size_t i = 0; i < count; ++i) {
    IssueSlot& slot = slots[i];
    slot.has_scalar = i % 3 == 2;
    slot.has_vector = !slot.has_scalar;
    slot.reads = i == 0 ? 0 : ComponentMask{1} << (4 * ((i - 1) % 12));
    (slot.has_scalar ? slot.scalar_writes : slot.vector_writes) = ComponentMask{1} << (4 * (i % 12));
  }
  return slots;
}

TEST(IssueReplay, ASteadyStreamGoesRoundAFewStates) {
  const auto slots = chain(78);
  IssueReplay replay(slots, three_threads());
  std::size_t settled = 0;
  for (int vertex = 0; vertex < 2000; ++vertex) {
    while (replay.logic().next_free() == 0) replay.take();
    if (replay.logic().next_free() != kNever) {
      replay.pass(replay.logic().next_free());
      continue;
    }
    replay.pass_next_end();
    if (vertex == 1000) settled = replay.states();
  }
  EXPECT_EQ(replay.states(), settled);
  EXPECT_LT(settled, 1000u);
}

// Vertices come at random; the logic goes cycle by cycle, the replay from event to event, with a table that
// is always full and with one that never is.
TEST(IssueReplay, DoesWhatTheLogicDoes) {
  std::mt19937 random(random_seed());
  for (const std::size_t most_states : {2u, 16u, 100'000u}) {
    const auto slots = chain(1 + random() % 40);
    const Machine::Vertex spec = three_threads();
    IssueLogic logic(slots, spec);
    IssueReplay replay(slots, spec, most_states);
    Cycle behind = 0;  // cycles that the replay has still to pass
    for (int cycle = 0; cycle < 20'000; ++cycle) {
      const auto issued = logic.issue();
      const bool ends = issued && issued->is_last;
      ++behind;
      const auto next = replay.next_end();
      ASSERT_EQ(ends, next.cycles == behind) << "cycle " << cycle;
      if (ends) {
        EXPECT_EQ(issued->thread, next.issued.thread);
        EXPECT_EQ(issued->result, next.issued.result);
        replay.pass_next_end();
        behind = 0;
      }
      if (logic.next_free() != 0 || random() % 50 != 0) continue;
      replay.pass(behind);
      behind = 0;
      ASSERT_EQ(replay.logic(), logic) << "cycle " << cycle;
      ASSERT_EQ(replay.take(), logic.take());
    }
    EXPECT_LE(replay.states(), most_states + 1);
  }
}

}  // namespace
}  // namespace splatscope::sim
