#include "sim/units/pixel/pixel_unit.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Timed;

Timed<std::uint32_t> shaded(std::uint64_t clocks, int quads_per_clock) {
  testing::TestDraw draw;
  for (int i = 0; i < 4; ++i) draw.add_quad(i, 0);
  draw.job.pixel_clocks = clocks;
  testing::Bench bench;
  testing::Source<std::uint32_t> source({{0, 0u}, {0, 1u}, {0, 2u}, {0, 3u}});
  PixelUnit pixel("pixel", bench.completion(), quads_per_clock);
  testing::Sink<std::uint32_t> sink;
  for (Unit* unit : {static_cast<Unit*>(&source), static_cast<Unit*>(&pixel), static_cast<Unit*>(&sink)})
    bench.add(*unit);
  Items in("in", source, pixel, 4), out("out", pixel, sink, 8, 16);
  source.connect(in);
  pixel.connect({&in, nullptr, nullptr}, out);
  sink.connect(out);
  bench.begin(draw.prepare(), {&pixel});
  bench.run();
  return sink.taken();
}

TEST(PixelUnit, AQuadAClockAndItsLatency) {
  EXPECT_EQ(shaded(1, 1), (Timed<std::uint32_t>{{17, 0u}, {18, 1u}, {19, 2u}, {20, 3u}}));
}

TEST(PixelUnit, ALongProgramTakesItsClocksAQuad) {
  EXPECT_EQ(shaded(3, 1), (Timed<std::uint32_t>{{17, 0u}, {20, 1u}, {23, 2u}, {26, 3u}}));
  // Two quads side by side, as they have come: one by cycle 1, two more by cycle 4.
  EXPECT_EQ(shaded(3, 2), (Timed<std::uint32_t>{{17, 0u}, {20, 1u}, {20, 2u}, {23, 3u}}));
}

}  // namespace
}  // namespace splatscope::sim
