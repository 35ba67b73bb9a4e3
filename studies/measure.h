#pragma once

#include <chrono>
#include <functional>
#include <vector>

// What studies measure with.
namespace splatscope::studies {

using HostClock = std::chrono::steady_clock;

inline double seconds_since(HostClock::time_point start) {
  return std::chrono::duration<double>(HostClock::now() - start).count();
}

// The upper one of an even number; 0 of none.
double median(std::vector<double> values);

// Of the host's seconds that `work` takes, over `repeats`, at least one.
double median_seconds(int repeats, const std::function<void()>& work);

}  // namespace splatscope::studies
