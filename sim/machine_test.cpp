#include "sim/machine.h"

#include <gtest/gtest.h>

namespace splatscope::sim {
namespace {

TEST(SimulatedMachine, ACycleOfTheBusIsTheCoresThatBeginsWithItOrNext) {
  Machine machine;
  machine.clock.core_megahertz = 100;
  machine.clock.bus_megahertz = 50;
  EXPECT_EQ(SimulatedMachine(machine, Scheduler::skip_ahead).core_cycle(7), 14u);
  machine.clock.bus_megahertz = 40;
  EXPECT_EQ(SimulatedMachine(machine, Scheduler::skip_ahead).core_cycle(3), 8u);
  EXPECT_EQ(SimulatedMachine(machine, Scheduler::skip_ahead).core_cycle(0), 0u);
}

}  // namespace
}  // namespace splatscope::sim
