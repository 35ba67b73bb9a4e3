#include "sim/units/blend/blend_unit.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

struct BlendBench {
  testing::Bench bench;
  testing::Source<std::uint32_t> source{{{0, 0u}, {0, 1u}}};
  BlendUnit blend;
  Items in;
  testing::TestMemory memory;

  BlendBench(bool blends, std::uint32_t bytes_per_pixel)
      : blend("blend", bench.completion(), {32, 4, 8}, FrameLines::of(64, 64, bytes_per_pixel), 1),
        in((bench.add(source), bench.add(blend), "in"), source, blend, 8),
        memory(bench, blend, 40) {
    testing::TestDraw draw;
    draw.draw.state.blend = blends;
    draw.add_quad(0, 0);
    draw.add_quad(1, 1);
    source.connect(in);
    blend.connect(in, memory.port, 4096);
    bench.begin(draw.prepare(), {&blend});
    bench.run();
  }
};

TEST(BlendUnit, BlendingReadsTheLineFirst) {
  const BlendBench run(true, 4);
  ASSERT_EQ(run.memory.memory.requests().size(), 1u);
  EXPECT_EQ(run.memory.memory.requests()[0].second.address, 4096u);
  EXPECT_EQ(run.bench.done_at(), 44u);  // leave in 42 and 43
}

TEST(BlendUnit, PlainWritesDoNotRead) {
  const BlendBench run(false, 4);
  EXPECT_TRUE(run.memory.memory.requests().empty());
  EXPECT_EQ(run.bench.done_at(), 4u);  // enter in 1 and 2, leave in 2 and 3
}

TEST(BlendUnit, AFloatLineIsReadInPartsOfOneMemoryChannelEach) {
  const BlendBench run(true, 16);
  ASSERT_EQ(run.memory.memory.requests().size(), 4u);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(run.memory.memory.requests()[i].second.address, 4096u + 64 * i);
    EXPECT_EQ(run.memory.memory.requests()[i].second.bytes, 64u);
  }
  EXPECT_EQ(run.bench.done_at(), 47u);  // the stub takes one request a cycle: the last part is there in 45
}

// What a sampled draw left out is in the cache: one line of it is hit, another written back for the last
// quad's. Quads that failed bring none.
TEST(BlendUnit, WhatWasLeftOutPassesThroughTheTags) {
  testing::Bench bench;
  testing::Source<std::uint32_t> source{{{0, 0u}, {0, 1u}, {0, 2u}}};
  BlendUnit blend("blend", bench.completion(), {4, 4, 8}, FrameLines::of(512, 512, 4), 1);
  Items in((bench.add(source), bench.add(blend), "in"), source, blend, 8);
  testing::TestMemory memory(bench, blend, 40);
  testing::TestDraw draw, left_out;
  draw.draw.state.blend = true;
  draw.add_quad(8, 0);   // its line is read, and leaves again
  draw.add_quad(10, 0);  // its line is in the cache
  draw.add_quad(20, 0);
  for (const int x : {2, 4, 6, 10}) left_out.add_quad(x, 0);
  left_out.add_quad(30, 0, {}, 0);
  Cuts cuts;
  cuts.add(0, 1).quads = left_out.work.quads;
  draw.job.cuts = &cuts;
  source.connect(in);
  blend.connect(in, memory.port, 0);
  bench.begin(draw.prepare(), {&blend});
  bench.run();
  std::vector<std::pair<std::uint32_t, bool>> traffic;
  for (const auto& [at, request] : memory.memory.requests())
    traffic.emplace_back(request.address / 64, request.write);
  EXPECT_EQ(traffic, (std::vector<std::pair<std::uint32_t, bool>>{{4, false}, {1, true}, {10, false}}));
}

}  // namespace
}  // namespace splatscope::sim
