#pragma once

#include <gtest/gtest.h>

#include "sim/simulate.h"

namespace splatscope::sim::testing {

// Where the cycles of a unit went in two runs that are to be the same.
inline void expect_same_books(const UnitBooks& a, const UnitBooks& b) {
  EXPECT_EQ(a.busy, b.busy) << b.name;
  EXPECT_EQ(a.starved, b.starved) << b.name;
  EXPECT_EQ(a.blocked_by, b.blocked_by) << b.name;
}

}  // namespace splatscope::sim::testing
