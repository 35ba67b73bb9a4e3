#include "sim/fidelity/traffic.h"

#include <gtest/gtest.h>

#include <functional>

#include "sim/testing/random_trace.h"

namespace splatscope::sim {
namespace {

Traffic traffic_of(TrafficCounter& counter, const DrawJob& job, const DrawWork& work) {
  counter.begin(job);
  counter.add_depth(work, 0);
  counter.add_color(work, 0);
  return counter.traffic();
}

// Bytes of depth that four quads of one triangle move, each in a line of its own.
double depth_bytes(bool fast_clear, bool clears, std::vector<ClearTile> clear_tiles) {
  testing::RandomTrace made = testing::simple_trace(1);
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  draw.state.depth_test = draw.state.depth_write = true;
  DrawWork& work = made.work[0];
  for (std::uint16_t i = 0; i < 4; ++i) work.quads[i].x = static_cast<std::uint16_t>(2 * i);
  work.clear_tiles = std::move(clear_tiles);
  Machine machine = machine::load(machine::kGeForce4);
  machine.depth.fast_clear = fast_clear;
  const MemoryLayout layout = lay_out(made.trace, machine);
  const PreparedDraws draws = prepare_draws(made.trace, made.work, machine, layout);
  TrafficCounter counter(machine, layout);
  if (clears) counter.clear();
  return 4 * traffic_of(counter, draws.jobs[0], work).depth;
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

// Of eight quads, each in a line of its own, that sample one block each, in three lines of the texture. The
// colour cache holds four lines.
Traffic color_traffic(const std::function<void(Draw&)>& change, int burst_bytes = 16) {
  testing::RandomTrace made = testing::simple_trace(2);
  made.trace.surfaces = 1;
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  draw.state.blend = false;
  change(draw);
  for (std::uint16_t i = 0; i < 8; ++i) {
    made.work[0].quads[i].x = static_cast<std::uint16_t>(2 * i);
    made.work[0].quads[i].y = 0;
  }
  made.work[0].texel_blocks = {0, 1, 2, 3, 7, 8, 8, 11};
  Machine machine = machine::load(machine::kGeForce4);
  machine.blend.cache_lines = 4;
  machine.blend.cache_ways = 1;
  machine.texture.line_bytes = 64;
  machine.texture.fill_bytes = 32;
  machine.memory.burst_bytes = burst_bytes;
  const MemoryLayout layout = lay_out(made.trace, machine);
  const PreparedDraws draws = prepare_draws(made.trace, made.work, machine, layout);
  TrafficCounter counter(machine, layout);
  return traffic_of(counter, draws.jobs[0], made.work[0]);
}

TEST(Traffic, ColourIsWrittenBackAndReadToBlend) {
  constexpr double kLine = 64;
  const double written = 8 * color_traffic([](Draw&) {}).color;
  EXPECT_EQ(written, 4 * kLine) << "the other four stay";
  EXPECT_EQ(8 * color_traffic([](Draw& draw) { draw.state.blend = true; }).color, written + 8 * kLine);
}

TEST(Traffic, AMissReadsAPartOfATextureLineAndAllOfASurfaces) {
  const Traffic texture = color_traffic([](Draw&) {});
  EXPECT_EQ(8 * texture.texture, 3 * 32);
  EXPECT_EQ(texture.texel_blocks, 1);
  EXPECT_EQ(8 * color_traffic([](Draw& draw) { draw.source = 1; }).texture, 3 * 64);
}

TEST(Traffic, IsOfWholeBursts) {
  const Traffic traffic = color_traffic([](Draw&) {}, 48);
  EXPECT_EQ(8 * traffic.texture, 3 * 48) << "for 32";
  EXPECT_EQ(8 * traffic.color, 4 * 96) << "for 64";
}

TEST(Traffic, NoColourIsNoTraffic) {
  const Traffic none = color_traffic([](Draw& draw) { draw.state.color_write = false; });
  EXPECT_EQ(none.color, 0);
  EXPECT_EQ(none.texture, 0);
  EXPECT_EQ(none.texel_blocks, 0);
}

// What was clear when a triangle began says nothing of the next one.
TEST(Traffic, ATileIsClearForItsTriangleAlone) {
  testing::RandomTrace made = testing::simple_trace(2);
  DrawWork& work = made.work[0];
  for (std::uint16_t i = 0; i < 8; ++i) {
    work.quads[i].x = static_cast<std::uint16_t>(2 * i);
    work.quads[i].y = 0;
  }
  work.clear_tiles = {{0, 0}, {0, 4}};  // the second is of the second triangle's first quad
  const Machine machine = machine::load(machine::kGeForce4);
  const MemoryLayout layout = lay_out(made.trace, machine);
  const PreparedDraws draws = prepare_draws(made.trace, made.work, machine, layout);
  TrafficCounter counter(machine, layout);
  counter.clear();
  EXPECT_EQ(8 * traffic_of(counter, draws.jobs[0], work).depth, 7 * 64);
}

}  // namespace
}  // namespace splatscope::sim
