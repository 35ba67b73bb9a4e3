#pragma once

#include <gtest/gtest.h>

#include <cstddef>

#include "sim/simulate.h"

namespace splatscope::sim::testing {

// Where the cycles of a unit went in two runs that are to be the same.
inline void expect_same_books(const UnitBooks& a, const UnitBooks& b) {
  EXPECT_EQ(a.busy, b.busy) << b.name;
  EXPECT_EQ(a.starved, b.starved) << b.name;
  EXPECT_EQ(a.blocked_by, b.blocked_by) << b.name;
}

// The same for all units of two runs, and the cycles.
inline void expect_same_times(const Result& a, const Result& b) {
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_EQ(a.command_ends, b.command_ends);
  ASSERT_EQ(a.units.size(), b.units.size());
  for (std::size_t i = 0; i < b.units.size(); ++i) expect_same_books(a.units[i], b.units[i]);
}

}  // namespace splatscope::sim::testing
