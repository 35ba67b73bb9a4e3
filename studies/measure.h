#pragma once

#include <chrono>
#include <functional>

// What studies measure with.
namespace splatscope::studies {

using HostClock = std::chrono::steady_clock;

inline double seconds_since(HostClock::time_point start) {
  return std::chrono::duration<double>(HostClock::now() - start).count();
}

// Of the host's seconds that `work` takes, over `repeats`, at least one.
double median_seconds(int repeats, const std::function<void()>& work);

}  // namespace splatscope::studies
