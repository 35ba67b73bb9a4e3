#include "sim/units/texture/texture_unit.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Timed;

struct TextureBench {
  testing::Bench bench;
  testing::Source<std::uint32_t> source;
  TextureUnit texture;
  testing::Sink<std::uint32_t> sink;
  Items in, out;
  testing::TestMemory memory;

  TextureBench(testing::TestDraw& draw, const Machine::Texture& spec, Cycle latency, int memory_queue = 64)
      : source(draw.quads()),
        texture("texture", bench.completion(), spec, 1),
        in((bench.add(source), bench.add(texture), "in"), source, texture, 8),
        out((bench.add(sink), "out"), texture, sink, 8),
        memory(bench, texture, latency, memory_queue) {
    source.connect(in);
    texture.connect({&in, nullptr, nullptr}, out, memory.port);
    sink.connect(out);
    draw.draw.texture = 0;
    bench.begin(draw.prepare(), {&texture});
    bench.run();
  }
};

Machine::Texture small_cache() {
  Machine::Texture spec;
  spec.cache_lines = 16;
  spec.cache_ways = 4;
  spec.pending = 8;
  return spec;
}

TEST(TextureUnit, WhatWasLeftOutPassesThroughTheTags) {
  testing::TestDraw draw, left_out;
  draw.add_quad(0, 0, {5});
  draw.add_quad(0, 0, {6});
  draw.add_quad(0, 0, {7});
  left_out.add_quad(0, 0, {4, 6});
  Cuts cuts;
  cuts.add(0, 1).blocks = left_out.work.texel_blocks;
  draw.job.cuts = &cuts;
  const TextureBench run(draw, small_cache(), 40);
  ASSERT_EQ(run.memory.memory.requests().size(), 2u);  // of 5 and 7
  EXPECT_EQ(run.memory.memory.requests()[1].second.address, 7u * 16);
}

TEST(TextureUnit, AMissTakesTheMemorysTimeAndAHitNone) {
  testing::TestDraw draw;
  draw.add_quad(0, 0, {5});
  draw.add_quad(1, 0, {5});
  const TextureBench run(draw, small_cache(), 40);
  // Looked up in 1, asked for in 1, seen by the memory in 2, there in 42, seen by the sink in 43. The second
  // quad hits and leaves one clock later.
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{43, 0u}, {44, 1u}}));
  ASSERT_EQ(run.memory.memory.requests().size(), 1u);
  EXPECT_EQ(run.memory.memory.requests()[0].second.address, 5u * 16u);
}

TEST(TextureUnit, MissesOverlap) {
  testing::TestDraw draw;
  for (std::uint32_t i = 0; i < 6; ++i) draw.add_quad(static_cast<int>(i), 0, {i});
  const TextureBench run(draw, small_cache(), 40);
  Timed<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 6; ++i) expected.emplace_back(43 + i, i);  // one a clock, not one a latency
  EXPECT_EQ(run.sink.taken(), expected);
}

TEST(TextureUnit, AFullFifoStopsTheLookUps) {
  testing::TestDraw draw;
  for (std::uint32_t i = 0; i < 4; ++i) draw.add_quad(static_cast<int>(i), 0, {i});
  Machine::Texture spec = small_cache();
  spec.pending = 2;
  const TextureBench run(draw, spec, 40);
  // Two wait; the third is looked up in 42, when the first leaves.
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{43, 0u}, {44, 1u}, {84, 2u}, {85, 3u}}));
}

TEST(TextureUnit, AQuadLooksUpOnlySoManyBlocksAClock) {
  testing::TestDraw draw;
  draw.add_quad(0, 0, {0, 1, 2, 3});
  Machine::Texture spec = small_cache();
  spec.lookups_per_clock = 1;
  const TextureBench run(draw, spec, 40);
  ASSERT_EQ(run.memory.memory.requests().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(run.memory.memory.requests()[i].first, 2 + i);
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{46, 0u}}));
}

TEST(TextureUnit, TheLeastRecentlyUsedLineGoes) {
  testing::TestDraw draw;
  Machine::Texture spec = small_cache();
  spec.cache_lines = 4;  // one set of four
  for (const std::uint32_t block : {0u, 1u, 2u, 3u, 0u, 4u, 0u, 1u}) draw.add_quad(0, 0, {block});
  const TextureBench run(draw, spec, 4);
  std::vector<std::uint32_t> asked;
  for (const auto& [at, request] : run.memory.memory.requests()) asked.push_back(request.address / 16);
  EXPECT_EQ(asked, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 1}));  // 4 took the place of 1
}

TEST(TextureUnit, QuadsWithoutATexturePassThrough) {
  testing::TestDraw draw;
  draw.add_quad(0, 0);
  const TextureBench run(draw, small_cache(), 40);
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{3, 0u}}));
}

TEST(TextureUnit, AMissReadsAPartOfATextureLineAndAllOfASurfaces) {
  for (const bool surface : {false, true}) {
    testing::TestDraw draw;
    draw.add_quad(0, 0, {5});
    if (surface) draw.draw.source = 1;
    Machine::Texture spec = small_cache();
    spec.line_bytes = 64;
    spec.fill_bytes = 32;
    const TextureBench run(draw, spec, 40);
    ASSERT_EQ(run.memory.memory.requests().size(), 1u);
    EXPECT_EQ(run.memory.memory.requests()[0].second.bytes, surface ? 64u : 32u);
  }
}

// Looks up in 1, 3, 5 and 7, as the memory takes a request in every second clock, and leaves in 48.
TEST(TextureUnit, IsBusyInEachClockThatItLooksUp) {
  testing::TestDraw draw;
  draw.add_quad(0, 0, {0, 1, 2, 3});
  const TextureBench run(draw, small_cache(), 40, 1);
  const Books books = run.bench.books(run.texture, run.bench.done_at());
  EXPECT_EQ(books.cycles[Step::kBusy], 5u);
}

}  // namespace
}  // namespace splatscope::sim
