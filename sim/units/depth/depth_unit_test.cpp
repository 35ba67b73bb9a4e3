#include "sim/units/depth/depth_unit.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Timed;

struct DepthBench {
  testing::Bench bench;
  testing::Source<std::uint32_t> source;
  DepthUnit depth;
  testing::Sink<std::uint32_t> sink;
  Items in, out;
  testing::TestMemory memory;

  DepthBench(testing::TestDraw& draw, const Machine::Depth& spec, bool cleared)
      : source(draw.quads()),
        depth("depth", bench.completion(), spec, FrameLines::of(512, 512, 4), 1),
        in((bench.add(source), bench.add(depth), "in"), source, depth, 8),
        out((bench.add(sink), "out"), depth, sink, 8),
        memory(bench, depth, 40) {
    source.connect(in);
    depth.connect(in, {nullptr, &out, &out}, memory.port, 0);
    sink.connect(out);
    depth.clear(cleared);
    bench.begin(draw.prepare(), {&depth});
    bench.run();
  }
  std::vector<std::pair<std::uint32_t, bool>> traffic() const {
    std::vector<std::pair<std::uint32_t, bool>> lines;
    for (const auto& [at, request] : memory.memory.requests())
      lines.emplace_back(request.address / 64, request.write);
    return lines;
  }
};

TEST(DepthUnit, QuadsOfAnAbsentLineWaitForItAndThoseThatFailedEndHere) {
  testing::TestDraw draw;
  draw.add_quad(0, 0);
  draw.add_quad(1, 1, {}, 0);  // the same 4x4 pixels; fails the test
  draw.add_quad(1, 0);
  const DepthBench run(draw, {32, 4, 8, 4, 8, true}, false);
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{43, 0u}, {45, 2u}}));
  EXPECT_EQ(run.traffic(), (std::vector<std::pair<std::uint32_t, bool>>{{0, false}}));
  EXPECT_EQ(run.bench.done_at(), 45u);
}

// What a sampled draw left out before a quad is in the cache, and its lines are no longer marked as cleared.
TEST(DepthUnit, WhatWasLeftOutPassesThroughTheTags) {
  testing::TestDraw draw, left_out;
  draw.add_quad(8, 0);
  draw.add_quad(0, 0);   // its line is in the cache
  draw.add_quad(64, 0);  // its line has left the cache again: is read
  left_out.add_quad(64, 0);
  for (int i = 0; i < 4; ++i) left_out.add_quad(128, 8 * i);  // the ways of its set
  left_out.add_quad(0, 0);
  Cuts cuts;
  cuts.add(0, 1).quads = left_out.work.quads;
  draw.job.cuts = &cuts;
  const DepthBench run(draw, {4, 4, 8, 4, 8, true}, true);
  EXPECT_EQ(run.traffic(), (std::vector<std::pair<std::uint32_t, bool>>{{4 * 128 + 64, true}, {32, false}}));
}

// However much of it there is.
TEST(DepthUnit, AllThatWasLeftOutPassesThroughTheTags) {
  testing::TestDraw draw, left_out;
  draw.add_quad(8, 0);
  draw.add_quad(64, 0);
  left_out.add_quad(64, 0);
  for (int i = 0; i < 20000; ++i) left_out.add_quad(0, 0);
  Cuts cuts;
  cuts.add(0, 1).quads = left_out.work.quads;
  draw.job.cuts = &cuts;
  const DepthBench run(draw, {4, 4, 8, 4, 8, true}, true);
  EXPECT_TRUE(run.traffic().empty());
}

TEST(DepthUnit, LinesThatAFastClearMarkedAreNotRead) {
  testing::TestDraw draw;
  draw.add_quad(0, 0);
  const DepthBench run(draw, {32, 4, 8, 4, 8, true}, true);
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{3, 0u}}));
  EXPECT_TRUE(run.traffic().empty());
}

TEST(DepthUnit, AWrittenLineGoesBackWhenItsPlaceIsTakenAndIsReadAgain) {
  testing::TestDraw draw;
  for (const int x : {0, 2, 4, 6, 8, 0}) draw.add_quad(x, 0);  // lines 0 1 2 3 4 0 in one set of four
  const DepthBench run(draw, {4, 4, 8, 4, 8, true}, true);
  EXPECT_EQ(run.traffic(), (std::vector<std::pair<std::uint32_t, bool>>{{0, true}, {1, true}, {0, false}}));
}

TEST(DepthUnit, ReadOnlyLinesAreNotWrittenBack) {
  testing::TestDraw draw;
  draw.draw.state.depth_write = false;
  for (const int x : {0, 2, 4, 6, 8}) draw.add_quad(x, 0);
  const DepthBench run(draw, {4, 4, 8, 4, 8, true}, false);
  for (const auto& [line, write] : run.traffic()) EXPECT_FALSE(write) << line;
  EXPECT_EQ(run.traffic().size(), 5u);
}

}  // namespace
}  // namespace splatscope::sim
