#include "studies/roofline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splatscope::studies {
namespace {

sim::Result result() {
  sim::Result made;
  made.cycles = 1000;
  made.seconds = 1e-5;  // 100 MHz
  made.frame_cycles = {1000};
  const auto add = [&](const char* unit, const char* name, std::uint64_t value) {
    made.statistics.push_back({unit, name, "", "", value});
  };
  add("vertex0", "issue_slots", 600);
  add("vertex1", "issue_slots", 400);
  add("vertex_fetch", "vertices", 77);
  add("raster", "quads", 250);
  add("memory0", "data_clocks", 100);
  add("memory1", "data_clocks", 300);
  return made;
}

// AGP counts clocks of its own, and a rate is of all frames.
TEST(Roofline, TheBusHasItsOwnClock) {
  Machine machine;
  machine.clock.core_megahertz = 100;
  machine.clock.bus_megahertz = 50;
  machine.agp.bytes_per_clock = 16;
  sim::Result two_frames = result();
  two_frames.frame_cycles = {400, 600};
  two_frames.statistics.push_back({"agp", "data_clocks", "", "", 50});
  const Ceiling bus = ceilings(machine, two_frames)[3];
  EXPECT_EQ(800, bus.demand);
  EXPECT_DOUBLE_EQ(800e6, bus.peak);
  EXPECT_DOUBLE_EQ(0.1, bus.share);  // 50 clocks of 500 in 10 us
  EXPECT_DOUBLE_EQ(2e6, bus.fps);    // twice in the time of 50 clocks
}

TEST(Roofline, CountsWhatTheRunAskedFor) {
  Machine machine;
  machine.clock.core_megahertz = 100;
  machine.vertex.units = 2;
  machine.pixel.quads_per_clock = 1;
  machine.memory.channels = 2;
  machine.memory.channel_bytes_per_clock = 8;
  const auto list = ceilings(machine, result());
  ASSERT_EQ(4u, list.size());
  EXPECT_EQ(1000, list[0].demand);
  EXPECT_DOUBLE_EQ(0.5, list[0].share);    // 1000 slots of 2 x 1000
  EXPECT_DOUBLE_EQ(0.25, list[1].share);   // 250 quads of 1000
  EXPECT_DOUBLE_EQ(3200, list[2].demand);  // 400 clocks of 8 bytes
  EXPECT_DOUBLE_EQ(0.2, list[2].share);    // of 2 x 1000 clocks
  EXPECT_DOUBLE_EQ(2e5, list[0].fps);      // twice the frame rate of the run
  EXPECT_EQ(0, list[3].demand);
  EXPECT_TRUE(std::isinf(list[3].fps));
  const auto json = json_of(list);
  for (const char* key : {"name", "unit", "what", "demand", "peak_per_second", "share", "frames_per_second"})
    EXPECT_TRUE(json[0].contains(key)) << key;
  // A roof for each of the three that were used, and a point under each slope.
  const auto plot = roofline_plot(list, 1e-5);
  ASSERT_TRUE(plot);
  ASSERT_EQ(5u, plot->series.size());
  // The run under fill: 4 instructions a quad, 1000 in 10 us.
  EXPECT_EQ(plot->series[2].x, (std::vector<double>{4}));
  EXPECT_DOUBLE_EQ(plot->series[2].y.at(0), 1e8);
  for (const Plot::Series& series : plot->series) {
    for (const double y : series.y) EXPECT_LE(y, list[0].peak) << series.name;
  }
  EXPECT_FALSE(roofline_plot(ceilings(machine, {}), 1));
}

}  // namespace
}  // namespace splatscope::studies
