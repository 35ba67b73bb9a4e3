#include "sim/units/raster/rasteriser.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Bench;
using testing::Sink;
using testing::Source;
using testing::TestDraw;
using testing::Timed;

// Triangles of the draw arrive in cycle 1; quads are taken from cycle `taken_from` on.
struct RasterBench {
  Bench bench;
  Source<std::uint32_t> source;
  Rasteriser raster;
  Sink<std::uint32_t> sink;
  Items in, out;

  RasterBench(TestDraw& draw, Machine::Raster spec, int quads_per_clock, Cycle taken_from, int room)
      : source({{0, 0u}, {0, 1u}}),
        raster("raster", bench.completion(), spec, quads_per_clock),
        sink(taken_from),
        in((bench.add(source), bench.add(raster), "in"), source, raster, 8),
        out((bench.add(sink), "out"), raster, sink, room, spec.latency) {
    source.connect(in);
    raster.connect(in, {&out, nullptr, nullptr});
    sink.connect(out);
    bench.begin(draw.prepare(), {&raster});
    bench.run();
  }
};

TestDraw two_triangles(int quads, int tiles) {
  TestDraw draw;
  draw.add_triangle(3, quads, tiles);
  draw.add_triangle(1, 1, 1);
  for (int i = 0; i < quads + 1; ++i) draw.add_quad(i, 0);
  return draw;
}

TEST(Rasteriser, SendsAQuadAClockAndTheNextTriangleAtOnce) {
  TestDraw draw = two_triangles(3, 1);
  const RasterBench run(draw, {1, 4, 8}, 1, 0, 8);
  EXPECT_EQ(run.sink.taken(),
            (Timed<std::uint32_t>{{5, 0u}, {6, 1u}, {7, 2u}, {8, 3u}}));  // sent at 1, 2, 3, 4
  EXPECT_EQ(run.bench.done_at(), 5u);
}

TEST(Rasteriser, TakesAsLongAsItsTiles) {
  TestDraw draw = two_triangles(1, 5);
  const RasterBench run(draw, {1, 1, 8}, 1, 0, 8);
  EXPECT_EQ(run.sink.taken(),
            (Timed<std::uint32_t>{{2, 0u}, {7, 1u}}));  // tiles in 1 to 5, the next triangle in 6
  TestDraw again = two_triangles(1, 5);
  const RasterBench faster(again, {5, 1, 8}, 1, 0, 8);
  EXPECT_EQ(faster.sink.taken(), (Timed<std::uint32_t>{{2, 0u}, {3, 1u}}));
}

TEST(Rasteriser, SendsTwoQuadsAClockWhereTheMachineIsThatWide) {
  TestDraw draw = two_triangles(3, 1);
  const RasterBench run(draw, {1, 1, 8}, 2, 0, 8);
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{2, 0u}, {2, 1u}, {3, 2u}, {4, 3u}}));
}

TEST(Rasteriser, IsBlockedUntilItsQuadsAreTaken) {
  TestDraw draw = two_triangles(3, 1);
  const RasterBench run(draw, {1, 1, 8}, 1, 10, 2);  // two fit; room again in cycle 11
  EXPECT_EQ(run.sink.taken(), (Timed<std::uint32_t>{{10, 0u}, {10, 1u}, {12, 2u}, {13, 3u}}));
  const Books books = run.bench.books(run.raster, 20);
  EXPECT_EQ(books.cycles[Step::kBlocked + run.sink.number()], 8u);  // cycles 3 to 10
  EXPECT_EQ(books.cycles[Step::kBusy], 4u);
  EXPECT_EQ(books.cycles[Step::kStarved], 1u);  // cycle 0
}

}  // namespace
}  // namespace splatscope::sim
