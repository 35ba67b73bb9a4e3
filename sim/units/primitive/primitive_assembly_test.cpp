#include "sim/units/primitive/primitive_assembly.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Timed;

// Groups of the one vertex unit, when they come; and the triangles that leave.
Timed<std::uint32_t> assemble(testing::TestDraw& draw, Timed<VertexGroup> groups,
                              const Machine::Primitive& spec, Cycle& done_at) {
  testing::Bench bench;
  Timed<std::uint8_t> units;
  for (const auto& [at, group] : groups) units.emplace_back(at, std::uint8_t{0});
  testing::Source<VertexGroup> source(std::move(groups));
  testing::Source<std::uint8_t> order_source(std::move(units));
  PrimitiveAssembly assembly("primitive", bench.completion(), spec);
  testing::Sink<std::uint32_t> sink;
  for (Unit* unit : {static_cast<Unit*>(&source), static_cast<Unit*>(&order_source),
                     static_cast<Unit*>(&assembly), static_cast<Unit*>(&sink)}) {
    bench.add(*unit);
  }
  Channel<VertexGroup> in("in", source, assembly, 8);
  Channel<std::uint8_t> order("order", order_source, assembly, 8);
  Channel<std::uint32_t> out("out", assembly, sink, 8);
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
  // Groups of two seen in 1 and 21, taken one a cycle: the first triangle in 22, with one vertex over for the
  // second.
  EXPECT_EQ(assemble(draw, {{0, {0, 2}}, {20, {1, 2}}}, {1, 4, 8}, done),
            (Timed<std::uint32_t>{{23, 0u}, {24, 1u}, {25, 2u}}));
  EXPECT_EQ(done, 25u);
}

TEST(PrimitiveAssembly, RejectedTrianglesEndHereAndClippedOnesTakeLonger) {
  testing::TestDraw draw;
  draw.add_triangle(3, 0, 0, 0);
  draw.add_triangle(0, 0, 1, 3);
  draw.add_triangle(0, 0, 1);
  Cycle done = 0;
  // Taken in 1; assembled in 2, 3 and, two further pieces of four clocks later, 12.
  EXPECT_EQ(assemble(draw, {{0, {0, 3}}}, {1, 4, 8}, done), (Timed<std::uint32_t>{{4, 1u}, {13, 2u}}));
}

}  // namespace
}  // namespace splatscope::sim
