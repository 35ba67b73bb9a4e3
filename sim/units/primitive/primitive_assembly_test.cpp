#include "sim/units/primitive/primitive_assembly.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Timed;

// Vertices of the one vertex unit, when they come; and the triangles that leave.
Timed<std::uint32_t> assemble(testing::TestDraw& draw, Timed<VertexNumber> vertices,
                              const Machine::Primitive& spec, Cycle& done_at) {
  testing::Bench bench;
  Timed<std::uint8_t> units;
  for (const auto& [at, vertex] : vertices) units.emplace_back(at, std::uint8_t{0});
  testing::Source<VertexNumber> source(std::move(vertices));
  testing::Source<std::uint8_t> order_source(std::move(units));
  PrimitiveAssembly assembly("primitive", bench.completion(), spec);
  testing::Sink<std::uint32_t> sink;
  for (Unit* unit : {static_cast<Unit*>(&source), static_cast<Unit*>(&order_source),
                     static_cast<Unit*>(&assembly), static_cast<Unit*>(&sink)}) {
    bench.add(*unit);
  }
  Channel<VertexNumber> in("in", source, assembly, 8);
  Channel<std::uint8_t> order("order", order_source, assembly, 8);
  Items out("out", assembly, sink, 8);
  source.connect(in);
  order_source.connect(order);
  assembly.connect(order, {&in}, out);
  sink.connect(out);
  bench.begin(draw.prepare(), {&assembly});
  bench.run();
  done_at = bench.done_at();
  return sink.taken();
}

TEST(PrimitiveAssembly, ATriangleWaitsForItsVertices) {
  testing::TestDraw draw;
  draw.add_triangle(3, 0, 1);
  draw.add_triangle(1, 0, 1);
  draw.add_triangle(0, 0, 1);
  Cycle done = 0;
  // Two vertices seen in 1 and 2, two in 21 and 22: the first triangle in 22, the second in 23.
  EXPECT_EQ(assemble(draw, {{0, 0}, {0, 1}, {20, 2}, {20, 3}}, {1, 4, 8}, done),
            (Timed<std::uint32_t>{{23, 0u}, {24, 1u}, {25, 2u}}));
  EXPECT_EQ(done, 25u);
}

TEST(PrimitiveAssembly, RejectedTrianglesEndHereAndClippedOnesTakeLonger) {
  testing::TestDraw draw;
  draw.add_triangle(3, 0, 0, 0);
  draw.add_triangle(0, 0, 1, 3);
  draw.add_triangle(0, 0, 1);
  Cycle done = 0;
  // Taken in 1 to 3; assembled in 4, 5 and, two further pieces of four clocks later, 14.
  EXPECT_EQ(assemble(draw, {{0, 0}, {0, 1}, {0, 2}}, {1, 4, 8}, done),
            (Timed<std::uint32_t>{{6, 1u}, {15, 2u}}));
}

// The last clocks of a draw belong to it, also where nothing goes on.
TEST(PrimitiveAssembly, ADrawLastsUntilItsLastTriangleIsAssembled) {
  testing::TestDraw draw;
  draw.add_triangle(3, 0, 0, 0);
  Cycle done = 0;
  EXPECT_TRUE(assemble(draw, {{0, 0}, {0, 1}, {0, 2}}, {14, 4, 8}, done).empty());
  EXPECT_EQ(done, 4u + 14u);
}

}  // namespace
}  // namespace splatscope::sim
