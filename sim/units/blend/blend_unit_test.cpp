#include "sim/units/blend/blend_unit.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

struct BlendBench {
  testing::Bench bench;
  testing::Source<std::uint32_t> source{{{0, 0u}, {0, 1u}}};
  BlendUnit blend;
  Channel<std::uint32_t> in;
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

}  // namespace
}  // namespace splatscope::sim
