#include "sim/units/setup/triangle_setup.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Timed;

TEST(TriangleSetup, TakesItsClocksForEachPiece) {
  testing::TestDraw draw;
  draw.add_triangle(3, 0, 1);
  draw.add_triangle(1, 0, 1, 3);  // clipped into three
  draw.add_triangle(1, 0, 1);
  testing::Bench bench;
  testing::Source<std::uint32_t> source({{0, 0u}, {0, 1u}, {0, 2u}});
  TriangleSetup setup("setup", bench.completion(), {2, 10, 4});
  testing::Sink<std::uint32_t> sink;
  for (Unit* unit : {static_cast<Unit*>(&source), static_cast<Unit*>(&setup), static_cast<Unit*>(&sink)})
    bench.add(*unit);
  Items in("in", source, setup, 4), out("out", setup, sink, 4, 10);
  source.connect(in);
  setup.connect(in, out);
  sink.connect(out);
  bench.begin(draw.prepare(), {&setup});
  bench.run();
  // Taken at 1, 3 and (three pieces of two clocks) 9; ten clocks through.
  EXPECT_EQ(sink.taken(), (Timed<std::uint32_t>{{11, 0u}, {13, 1u}, {19, 2u}}));
  EXPECT_EQ(bench.done_at(), 11u) << "the last takes 9 and 10";
}

}  // namespace
}  // namespace splatscope::sim
