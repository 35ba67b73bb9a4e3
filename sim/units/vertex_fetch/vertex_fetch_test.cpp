#include "sim/units/vertex_fetch/vertex_fetch.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

// Vertices of 32 bytes, two a line, for two vertex units that take what they get at once.
struct FetchBench {
  testing::Bench bench;
  VertexFetch fetch;
  testing::Sink<VertexNumber> first, second;
  testing::Sink<std::uint8_t> order_sink;
  Channel<VertexNumber> to_first, to_second;
  Channel<std::uint8_t> order;
  testing::TestMemory indices, vertices;

  FetchBench(testing::TestDraw& draw, const Machine::Fetch& spec, Cycle second_from, Cycle first_from = 0)
      : fetch("vertex_fetch", bench.completion(), spec),
        first(first_from),
        second(second_from),
        to_first((bench.add(fetch), bench.add(first), "to first"), fetch, first, 1),
        to_second((bench.add(second), "to second"), fetch, second, 1),
        order((bench.add(order_sink), "order"), fetch, order_sink, 16),
        indices(bench, fetch, 10),
        vertices(bench, fetch, 10) {
    first.connect(to_first);
    second.connect(to_second);
    order_sink.connect(order);
    fetch.connect({&indices.port, &vertices.port}, {}, {&to_first, &to_second}, order);
    fetch.set_places({MemoryPlace::video, MemoryPlace::video});
    draw.draw.vertex_stride = 32;
    draw.draw.index_buffer = 1;
    draw.job.vertex_address = 0x10000;
    bench.begin(draw.prepare(), {&fetch});
    bench.run();
  }
};

// A quad as the surfels have it: vertices 0 1 2 are new, then 3.
testing::TestDraw two_quads() {
  testing::TestDraw draw;
  for (int quad = 0; quad < 2; ++quad) {
    draw.add_triangle(3, 0, 1);
    draw.add_triangle(1, 0, 1);
  }
  draw.work.shaded_vertices = {0, 1, 2, 3, 4, 5, 6, 7};
  return draw;
}

TEST(VertexFetch, ReadsIndicesThenVerticesAndHandsThemOutInOrder) {
  testing::TestDraw draw = two_quads();
  Machine::Fetch spec;
  const FetchBench run(draw, spec, 0);
  // Index line asked for in 0, seen by memory in 1, there in 11. Then 3 clocks a triangle: vertices 0 1 2 in
  // 11, 3 in 14, 4 5 6 in 17, 7 in 20. Vertex lines: there 11 cycles after they are asked for, one a cycle:
  // lines 0 and 1, asked for in 11, in 22 and 23; lines 2 and 3, asked for in 17, in 28 and 29. One vertex
  // leaves a cycle.
  EXPECT_EQ(run.indices.memory.requests().size(), 1u);
  ASSERT_EQ(run.vertices.memory.requests().size(), 4u);
  EXPECT_EQ(run.vertices.memory.requests()[0].second.address, 0x10000u);
  EXPECT_EQ(run.vertices.memory.requests()[3].second.address, 0x10000u + 3 * 64);
  std::vector<std::uint8_t> order;
  std::vector<Cycle> left;
  for (const auto& [at, unit] : run.order_sink.taken()) {
    order.push_back(unit);
    left.push_back(at - 1);
  }
  EXPECT_EQ(left, (std::vector<Cycle>{22, 23, 24, 25, 28, 29, 30, 31}));
  // Each goes to the first unit with room: the slot of unit 0, taken in 23, is free in 24.
  EXPECT_EQ(order, (std::vector<std::uint8_t>{0, 1, 0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(run.first.taken().back().second, kEndOfDraw);  // the end of the draw
  EXPECT_EQ(run.second.taken().back().second, kEndOfDraw);
}

// A triangle a clock: vertices 4 5 6 are asked for in 13, two clocks after the first, and no vertex waits.
TEST(VertexFetch, MayTakeAllIndicesOfATriangleInAClock) {
  testing::TestDraw draw = two_quads();
  Machine::Fetch spec;
  spec.indices_per_clock = 3;
  const FetchBench run(draw, spec, 0);
  std::vector<Cycle> left;
  for (const auto& [at, unit] : run.order_sink.taken()) left.push_back(at - 1);
  EXPECT_EQ(left, (std::vector<Cycle>{22, 23, 24, 25, 26, 27, 28, 29}));
}

// What a sampled draw left out before vertex 4 has brought the line of vertices 4 and 5, and taken nothing.
TEST(VertexFetch, WhatWasLeftOutPassesThroughTheTags) {
  testing::TestDraw draw = two_quads();
  Cuts cuts;
  cuts.add(4, 0).vertices = {4, 5};
  draw.job.cuts = &cuts;
  const FetchBench run(draw, {}, 0);
  ASSERT_EQ(run.vertices.memory.requests().size(), 3u);
  EXPECT_EQ(run.vertices.memory.requests()[2].second.address, 0x10000u + 3 * 64);
}

TEST(VertexFetch, GoesToTheUnitThatIsFree) {
  testing::TestDraw draw = two_quads();
  const FetchBench run(draw, {}, 200);  // the second takes nothing until then
  std::vector<std::uint8_t> order;
  for (const auto& [at, unit] : run.order_sink.taken()) order.push_back(unit);
  EXPECT_EQ(order, (std::vector<std::uint8_t>{0, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(run.bench.done_at(), 202u);  // the end of the draw reaches the second unit in 201
}

// The channels hold one vertex each, handed out in 22 and 23. What is taken in 200 leaves room in 201.
TEST(VertexFetch, IsBlockedWhileNoUnitHasRoom) {
  testing::TestDraw draw = two_quads();
  const FetchBench run(draw, {}, 200, 200);
  const Books books = run.bench.books(run.fetch, run.bench.done_at());
  constexpr std::size_t kBlockedByFirst = 3 + 2;  // the second unit after the one that waits for the draw
  EXPECT_EQ(books.cycles[kBlockedByFirst], 201u - 24);
}

// The indices of 32 triangles fill three lines of 64 bytes.
TEST(VertexFetch, ReadsTheLinesThatHoldItsIndicesAlone) {
  testing::TestDraw draw;
  for (int i = 0; i < 32; ++i) draw.add_triangle(i == 0 ? 3 : 0, 0, 1);
  draw.work.shaded_vertices = {0, 1, 2};
  const FetchBench run(draw, {}, 0);
  EXPECT_EQ(run.indices.memory.requests().size(), 3u);
}

// Two clocks a triangle: vertices 4 5 6 are asked for in 15.
TEST(VertexFetch, ATriangleTakesWholeClocks) {
  testing::TestDraw draw = two_quads();
  Machine::Fetch spec;
  spec.indices_per_clock = 2;
  const FetchBench run(draw, spec, 0);
  ASSERT_EQ(run.vertices.memory.requests().size(), 4u);
  EXPECT_EQ(run.vertices.memory.requests()[2].first, 16u);
}

}  // namespace
}  // namespace splatscope::sim
