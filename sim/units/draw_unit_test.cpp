#include "sim/units/draw_unit.h"

#include <gtest/gtest.h>

namespace splatscope::sim {
namespace {

class TwoItems final : public DrawUnit {
 public:
  using DrawUnit::DrawUnit;
  Step advance(Cycle now) override {
    item_done(now);
    return busy(now + 1);
  }
  std::uint64_t items(const DrawJob&) const override { return 2; }
};

// Else it would count down from 2^64, and be starved to the end.
TEST(DrawUnit, AnItemThatNoDrawHasIsAModelError) {
  Completion completion;
  TwoItems unit("two", completion), waiter("waiter", completion);
  EXPECT_THROW(unit.advance(0), ModelError) << "it was never told to begin";
  ClockDomain domain("core", 1, 1, Scheduler::referee);
  domain.add(waiter, 0);
  completion.set_waiter(waiter);
  completion.start(0, 1);
  const DrawJob job{};
  EXPECT_TRUE(unit.begin(job));
  for (Cycle now = 1; now < 3; ++now) EXPECT_NO_THROW(unit.advance(now));
  EXPECT_EQ(completion.done_at(), 3u);
  EXPECT_THROW(unit.advance(3), ModelError);
}

}  // namespace
}  // namespace splatscope::sim
