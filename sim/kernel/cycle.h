#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace splatscope::sim {

using Cycle = std::uint64_t;  // of the clock domain at hand, from 0 at the start of a run
inline constexpr Cycle kNever = std::numeric_limits<Cycle>::max();

using Femtoseconds = std::uint64_t;  // 2^64 fs are five hours

inline Femtoseconds femtoseconds_of(double nanoseconds) {
  return static_cast<Femtoseconds>(std::llround(nanoseconds * 1e6));
}
// Whole cycles of a clock that `time` takes.
inline Cycle cycles_of(Femtoseconds time, Femtoseconds period) {
  return (time + period - 1) / period;
}

}  // namespace splatscope::sim
