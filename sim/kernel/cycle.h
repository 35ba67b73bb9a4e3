#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace splatscope::sim {

using Cycle = std::uint64_t;  // of the clock domain at hand, from 0 at the start of a run
inline constexpr Cycle kNever = std::numeric_limits<Cycle>::max();

using Femtoseconds = std::uint64_t;
// Five hours: what a run may take. 2^64 fs are seven minutes more, so a time and a step that begins before it
// can be added.
inline constexpr Femtoseconds kMostTime = 18'000'000'000'000'000'000u;

inline Femtoseconds femtoseconds_of(double nanoseconds) {
  return static_cast<Femtoseconds>(std::llround(nanoseconds * 1e6));
}
inline Femtoseconds period_of(double megahertz) {
  return static_cast<Femtoseconds>(std::llround(1e9 / megahertz));
}
inline double seconds_of(Cycle cycles, Femtoseconds period) {
  return static_cast<double>(cycles) * static_cast<double>(period) * 1e-15;
}
// Whole cycles of a clock that `time` takes.
inline Cycle cycles_of(Femtoseconds time, Femtoseconds period) {
  return (time + period - 1) / period;
}

}  // namespace splatscope::sim
