#pragma once

#include <cstdint>
#include <limits>

namespace splatscope::sim {

using Cycle = std::uint64_t;  // of the clock domain at hand, from 0 at the start of a run
inline constexpr Cycle kNever = std::numeric_limits<Cycle>::max();

using Femtoseconds = std::uint64_t;  // 2^64 fs are five hours

}  // namespace splatscope::sim
