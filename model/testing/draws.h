#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/command/commands.h"
#include "model/work/work.h"

// What tests of drawing make and compare.
namespace splatscope::testing {

template <typename Values>
Buffer buffer_of(const Values& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {MemoryPlace::video, {bytes.begin(), bytes.end()}};
}

inline std::vector<std::array<unsigned, 5>> listed(std::span<const QuadWork> quads) {
  std::vector<std::array<unsigned, 5>> all;
  for (const QuadWork& quad : quads)
    all.push_back({quad.x, quad.y, quad.covered, quad.passed, quad.texel_block_count});
  return all;
}

}  // namespace splatscope::testing
