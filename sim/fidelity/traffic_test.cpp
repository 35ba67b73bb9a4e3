#include "sim/fidelity/traffic.h"

#include <gtest/gtest.h>

#include "sim/testing/random_trace.h"

namespace splatscope::sim {
namespace {

// Bytes of depth that four quads of one triangle move, each in a line of its own.
double depth_bytes(bool fast_clear, bool clears, std::vector<ClearTile> clear_tiles) {
  testing::RandomTrace made = testing::simple_trace(1);
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  draw.state.depth_test = draw.state.depth_write = true;
  DrawWork& work = made.work[0];
  for (std::uint16_t i = 0; i < 4; ++i) work.quads[i].x = static_cast<std::uint16_t>(2 * i);
  work.clear_tiles = std::move(clear_tiles);
  Machine machine = machine::load("geforce4-ti4400");
  machine.depth.fast_clear = fast_clear;
  const MemoryLayout layout = lay_out(made.trace, machine);
  const PreparedDraws draws = prepare_draws(made.trace, made.work, machine, layout);
  TrafficCounter counter(machine, layout);
  if (clears) counter.clear();
  return 4 * counter.of(draws.jobs[0]).depth;
}

TEST(Traffic, ClearLinesOfDepthAreNotRead) {
  constexpr double kLine = 64;
  EXPECT_EQ(depth_bytes(true, true, {}), 4 * kLine);
  EXPECT_EQ(depth_bytes(true, true, {{0, 0}, {0, 3}}), 2 * kLine);
  EXPECT_EQ(depth_bytes(true, true, {{0, 0}, {0, 0}, {0, 9}}), 3 * kLine) << "noted twice, and elsewhere";
  EXPECT_EQ(depth_bytes(true, true, {{1, 0}}), 4 * kLine) << "of another triangle";
  EXPECT_EQ(depth_bytes(false, true, {{0, 0}}), 4 * kLine) << "a clear that writes";
  EXPECT_EQ(depth_bytes(true, false, {{0, 0}}), 4 * kLine) << "never cleared";
}

}  // namespace
}  // namespace splatscope::sim
