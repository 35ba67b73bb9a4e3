#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "program.h"

// What the tests of the command line have in common.
namespace splatscope::tests {

// Exit 2 and exactly one line, which holds `part`.
inline void expect_refused(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_NE(outcome.error.find(part), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("expected"), std::string::npos) << outcome.error;
}

inline constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\n";

inline constexpr const char* kSmallScene =
    "[surfels]\ncolumns = 16\nrows = 16\n[camera]\neye = [0, 6, 14]\ntarget = [0, 0, 0]\n"
    "[frame]\nwidth = 64\nheight = 48\n";

}  // namespace splatscope::tests
