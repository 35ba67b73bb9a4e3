#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>

namespace splatscope::testing {

// Calls `run` once with each of this machine's SIMD targets in use, the plainest first.
template <typename Run>
void on_each_simd_target(Run run) {
  const std::int64_t available = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t bit = INT64_MIN; bit != 0;
       bit = static_cast<std::int64_t>(static_cast<std::uint64_t>(bit) >> 1)) {
    if ((available & bit) == 0) continue;
    SCOPED_TRACE(hwy::TargetName(bit));
    hwy::SetSupportedTargetsForTest(bit);
    run();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace splatscope::testing
