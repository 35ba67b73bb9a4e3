#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <random>

namespace splatscope {

// Another in every run, or that of --gtest_random_seed, which repeats a run. Printed at once: what gtest
// traces is lost where a test ends in an exception or a signal.
inline unsigned random_seed() {
  constexpr unsigned kMost = 99999;  // of gtest's flag
  const int given = GTEST_FLAG_GET(random_seed);
  const unsigned seed = given != 0 ? static_cast<unsigned>(given) : 1 + std::random_device{}() % kMost;
  std::cout << "--gtest_random_seed=" << seed << '\n' << std::flush;
  return seed;
}

}  // namespace splatscope
