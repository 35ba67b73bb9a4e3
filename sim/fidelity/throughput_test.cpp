#include "sim/fidelity/throughput.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/command/load_program.h"
#include "sim/fidelity/stretches.h"
#include "sim/testing/random_trace.h"
#include "sim/units/vertex/vertex_clocks.h"

namespace splatscope::sim {
namespace {

using testing::RandomTrace;

RandomTrace plain() {
  return testing::simple_trace(4000);
}

// Every quad in a line of its own, which is clear.
RandomTrace spread_out() {
  RandomTrace made = plain();
  made.trace.width = made.trace.height = 1024;
  DrawWork& work = made.work[0];
  for (std::uint32_t i = 0; i < work.quads.size(); ++i) {
    work.quads[i].x = static_cast<std::uint16_t>(i % 256 * 2);
    work.quads[i].y = static_cast<std::uint16_t>(i / 256 * 2);
    work.clear_tiles.push_back({i / 4, i});
  }
  return made;
}

// Four texels a quad, always the same.
RandomTrace textured() {
  RandomTrace made = plain();
  DrawWork& work = made.work[0];
  work.texel_blocks.clear();
  for (QuadWork& quad : work.quads) {
    quad.texel_block_count = 4;
    work.texel_blocks.insert(work.texel_blocks.end(), {0, 1, 2, 3});
  }
  return made;
}

RandomTrace in_host_memory() {
  RandomTrace made = plain();
  for (Buffer& buffer : made.trace.buffers) buffer.place = MemoryPlace::agp;
  return made;
}

struct Bottleneck {
  RandomTrace (*scene)();
  std::vector<std::string> settings;
  std::string unit;
};

class Bottlenecks : public ::testing::TestWithParam<Bottleneck> {};

// Each machine is slow in one unit, which then sets the time of both.
TEST_P(Bottlenecks, SetTheEstimateAsTheySetTheSimulation) {
  Machine machine = machine::load(machine::kGeForce4);
  for (const std::string& setting : GetParam().settings) machine::assign(machine, setting);
  machine::check(machine);
  const RandomTrace made = GetParam().scene();
  const Result estimate = estimate_throughput(made.trace, made.work, machine);
  const Result simulated = simulate(made.trace, made.work, machine);
  EXPECT_EQ(GetParam().unit, simulated.bottleneck().unit);
  EXPECT_EQ(GetParam().unit, estimate.bottleneck().unit);
  EXPECT_NEAR(1.0, static_cast<double>(estimate.cycles) / static_cast<double>(simulated.cycles), 0.02);
  EXPECT_NEAR(static_cast<double>(simulated.bottleneck().busy),
              static_cast<double>(estimate.bottleneck().busy), 0.02 * static_cast<double>(simulated.cycles));
}

const Bottleneck kBottlenecks[] = {
    {plain, {"vertex.units=1"}, "vertex0"},
    {plain, {"setup.clocks_per_triangle=64"}, "setup"},
    {plain, {"primitive.clocks_per_triangle=64"}, "primitive"},
    {plain, {"host.command_nanoseconds=1e6"}, "host"},
    {spread_out, {"memory.channels=1"}, "memory0"},
    {textured,
     {"texture.lookups_per_clock=1", "vertex.units=8", "memory.channel_bytes_per_clock=16",
      "memory.burst_bytes=16"},
     "texture"},
    {in_host_memory, {"agp.bytes_per_clock=1"}, "agp"},
    {in_host_memory, {"agp.bytes_per_clock=7"}, "agp"},  // 9.1 clocks a line, and takes 10
    {in_host_memory, {"agp.latency_nanoseconds=20000", "agp.bytes_per_clock=256"}, "agp"},  // a full queue
};

INSTANTIATE_TEST_SUITE_P(Units, Bottlenecks, ::testing::ValuesIn(kBottlenecks));

TEST(Throughput, ClocksAreQuotientsRoundedUp) {
  constexpr std::uint32_t kMost = 1U << 26;
  for (std::uint32_t a_clock = 1; a_clock <= 16; ++a_clock) {
    const ClocksOf clocks(static_cast<int>(a_clock));
    for (std::uint32_t i = 0; i < 1000; ++i)
      for (const std::uint32_t items : {i, kMost - i, (kMost / 2 / a_clock + i) * a_clock})
        ASSERT_EQ((items + a_clock - 1) / a_clock, clocks(items)) << items << " at " << a_clock;
  }
}

TEST(Throughput, ADrawPaysForTheUnitsThatItUsesAlone) {
  const auto cycles_of = [](const Draw& draw, int depth, int texture, int pixel, bool simulated = false) {
    RandomTrace made = testing::simple_trace(1);
    std::get<Draw>(made.trace.commands[1]) = draw;
    if (!binds_texture(draw)) {
      for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
      made.work[0].texel_blocks.clear();
    }
    Machine machine = machine::load(machine::kGeForce4);
    machine.depth.latency = depth;
    machine.texture.latency = texture;
    machine.pixel.latency = pixel;
    return simulated ? simulate(made.trace, made.work, machine).cycles
                     : estimate_throughput(made.trace, made.work, machine).cycles;
  };
  const Draw whole = std::get<Draw>(testing::simple_trace(1).trace.commands[1]);
  Draw untextured = whole, no_depth = whole, depth_alone = whole;
  untextured.texture.reset();
  no_depth.state.depth_test = no_depth.state.depth_write = false;
  depth_alone.state.color_write = false;
  const auto added = [&](const Draw& draw) {
    return cycles_of(draw, 100, 120, 150) - cycles_of(draw, 10, 10, 10);
  };
  EXPECT_EQ(added(whole), 90u + 110u + 140u);
  EXPECT_EQ(added(untextured), 90u + 140u);
  EXPECT_EQ(added(no_depth), 110u + 140u);
  EXPECT_EQ(added(depth_alone), 0u);  // its quads end at the test
  EXPECT_EQ(cycles_of(depth_alone, 100, 120, 150, true), cycles_of(depth_alone, 10, 10, 10, true));
}

// Draws one after the other, each of the same triangles.
RandomTrace draws_of(int triangles, int draws, MemoryPlace place) {
  RandomTrace made = testing::simple_trace(triangles);
  for (Buffer& buffer : made.trace.buffers) buffer.place = place;
  const Draw draw = std::get<Draw>(made.trace.commands[1]);
  for (int i = 1; i < draws; ++i) {
    made.work.push_back(made.work[0]);
    made.work.back().command = static_cast<std::uint32_t>(made.trace.commands.size());
    made.trace.commands.emplace_back(draw);
  }
  return made;
}

TEST(Throughput, AShortDrawWaitsForTheMemoryThatItsBuffersLieIn) {
  Machine machine = machine::load(machine::kGeForce4);
  machine.host.command_nanoseconds = 0;
  machine.agp.latency_nanoseconds = 10000;
  for (const MemoryPlace place : {MemoryPlace::video, MemoryPlace::agp}) {
    const RandomTrace made = draws_of(1, 50, place);
    const auto estimated = static_cast<double>(estimate_throughput(made.trace, made.work, machine).cycles);
    const auto simulated = static_cast<double>(simulate(made.trace, made.work, machine).cycles);
    // What units hand to each other takes a clock each time: a quarter of the shortest draws.
    EXPECT_NEAR(estimated / simulated, 1, 0.25) << "place " << static_cast<int>(place);
  }
}

TEST(Throughput, ADrawOfNothingBeginsNoUnit) {
  Machine machine = machine::load(machine::kGeForce4);
  machine.host.command_nanoseconds = 0;
  RandomTrace made = testing::simple_trace(1);
  std::get<Draw>(made.trace.commands[1]).index_count = 0;
  DrawWork nothing;
  nothing.command = 1;
  made.work = {nothing};
  const auto with = [&](const RandomTrace& trace) {
    return estimate_throughput(trace.trace, trace.work, machine).cycles;
  };
  const Cycle one = with(made);
  made.trace.commands.push_back(made.trace.commands[1]);
  nothing.command = 2;
  made.work.push_back(nothing);
  EXPECT_EQ(with(made), one);
}

TEST(Throughput, NormalisingOnTheHostCostsWhatItsReadsDo) {
  RandomTrace made = testing::simple_trace(10);
  made.trace.commands.emplace_back(NormalizeOnHost{});
  made.trace.commands.emplace_back(Present{});
  const Machine machine = machine::load(machine::kRadeon8500);
  const Result estimate = estimate_throughput(made.trace, made.work, machine);
  const Result simulated = simulate(made.trace, made.work, machine);
  EXPECT_NEAR(1.0, static_cast<double>(estimate.cycles) / static_cast<double>(simulated.cycles), 1e-3);
  EXPECT_EQ(estimate.command_ends.size(), simulated.command_ends.size());
  ASSERT_EQ(estimate.frame_cycles.size(), 1u);
  EXPECT_EQ(estimate.frame_cycles[0], estimate.cycles);
}

// A queue holds what is on its way through a unit too: no more of it passes in the unit's latency.
TEST(Throughput, ALatencyThatFillsAQueueSetsThePace) {
  for (const std::string_view setting :
       {"setup.latency", "raster.latency", "depth.latency", "texture.latency", "pixel.latency"}) {
    Machine machine = machine::load(machine::kGeForce4);
    for (const std::string& more :
         {std::string("vertex.units=16"), std::string("depth.queue=4"), std::string("setup.queue=4"),
          std::string("raster.queue=4"), std::string("texture.queue=4"), std::string("pixel.queue=4"),
          fmt::format("{}=200", setting)})
      machine::assign(machine, more);
    const RandomTrace made = textured();
    const auto estimate = static_cast<double>(estimate_throughput(made.trace, made.work, machine).cycles);
    const auto simulated = static_cast<double>(simulate(made.trace, made.work, machine).cycles);
    EXPECT_NEAR(estimate / simulated, 1, 0.05) << setting;
  }
}

TEST(Throughput, UnitsThatADrawGoesPastAreNotBusyWithIt) {
  RandomTrace made = textured();
  auto& draw = std::get<Draw>(made.trace.commands[1]);
  draw.state.depth_test = draw.state.depth_write = false;
  made.trace.commands.push_back(made.trace.commands[1]);  // a small one, that needs the unit
  auto& small = std::get<Draw>(made.trace.commands.back());
  small.state.depth_test = true;
  small.index_count = 0;
  made.work.emplace_back().command = static_cast<std::uint32_t>(made.trace.commands.size() - 1);
  const Machine machine = machine::load(machine::kGeForce4);
  const Result estimate = estimate_throughput(made.trace, made.work, machine);
  EXPECT_EQ(std::ranges::find(estimate.units, "depth", &UnitBooks::name)->busy, 0u);
}

// Quads that neither depth nor colour takes end in the rasteriser: they wait for no place behind it.
TEST(Throughput, QuadsThatNothingTakesHoldNoQueue) {
  RandomTrace made = plain();
  DrawState& state = std::get<Draw>(made.trace.commands[1]).state;
  state.depth_test = state.depth_write = state.color_write = false;
  Machine machine = machine::load(machine::kGeForce4);
  for (const char* setting : {"raster.latency=256", "raster.queue=1"}) machine::assign(machine, setting);
  const auto estimate = static_cast<double>(estimate_throughput(made.trace, made.work, machine).cycles);
  const auto simulated = static_cast<double>(simulate(made.trace, made.work, machine).cycles);
  EXPECT_NEAR(estimate / simulated, 1, 0.05);
}

// Where no draw uses depth there is none to clear. The simulation has the latency of its writes besides.
TEST(Throughput, ClearsTheBuffersThatTheSimulationClears) {
  Machine machine = machine::load(machine::kGeForce4);
  machine.depth.fast_clear = false;
  for (const bool depth : {false, true}) {
    RandomTrace made = testing::simple_trace(10);
    auto& draw = std::get<Draw>(made.trace.commands[1]);
    draw.state.depth_test = draw.state.depth_write = depth;
    made.trace.width = made.trace.height = 1024;
    const Result estimate = estimate_throughput(made.trace, made.work, machine);
    const Result simulated = simulate(made.trace, made.work, machine);
    const double bytes = 1024 * 1024 * (depth ? 8 : 4);
    EXPECT_NEAR(memory_clocks(bytes, machine), static_cast<double>(estimate.command_ends[0]),
                0.01 * static_cast<double>(estimate.command_ends[0]));
    EXPECT_NEAR(
        1.0, static_cast<double>(estimate.command_ends[0]) / static_cast<double>(simulated.command_ends[0]),
        0.1);
  }
}

// Four corners from a vertex: what does not depend on the corner runs once.
TEST(Throughput, WhatIfAVertexEmitsFourCorners) {
  const Machine machine = machine::load(machine::kGeForce4);
  RandomTrace made = testing::simple_trace(4000);
  const auto vertex_clocks = [&](const WhatIf& what_if) {
    const Result result = estimate_throughput(made.trace, made.work, machine, what_if);
    return static_cast<double>(std::ranges::find(result.units, "vertex0", &UnitBooks::name)->busy);
  };
  const double as_in_2002 = vertex_clocks({});
  const std::vector<std::uint32_t> nothing(made.trace.programs.size(), 0), everything(nothing.size(), ~0u);
  EXPECT_NEAR(vertex_clocks({.corner_inputs = nothing}) / as_in_2002, 0.25, 0.01);
  // Instructions of constants alone could run once; this program has none. The reload is saved.
  EXPECT_LE(vertex_clocks({.corner_inputs = everything}), as_in_2002);
  EXPECT_GT(vertex_clocks({.corner_inputs = everything}), 0.6 * as_in_2002);
  EXPECT_NEAR(vertex_clocks({.point_sprites = true}) / as_in_2002, 0.25, 0.01);
}

// What tells the corners apart is made by the unit, so no vertex brings it.
TEST(Throughput, WhatIfAVertexEmitsFourCornersItReadsNoneOfThem) {
  Draw draw;
  draw.vertex_program = 1;
  draw.vertex_stride = 24;
  draw.attributes = {{.input = 0, .format = VertexFormat::float3, .offset = 0},
                     {.input = 5, .format = VertexFormat::float2, .offset = 12},
                     {.input = 7, .format = VertexFormat::float1, .offset = 20}};
  EXPECT_EQ(bytes_of_vertex(draw, {}), 24);
  EXPECT_EQ(bytes_of_vertex(draw, {.corner_inputs = {1u << 0, 1u << 5}}), 24 - 2 * 4);
  EXPECT_EQ(bytes_of_vertex(draw, {.point_sprites = true}), 24);
}

TEST(Throughput, WhatIfAUnitDividesPixels) {
  RandomTrace made = testing::simple_trace(10);
  made.trace.commands.emplace_back(NormalizeOnHost{});
  const Machine machine = machine::load(machine::kGeForce4);
  const auto cycles = [&](int pixels) {
    return estimate_throughput(made.trace, made.work, machine, {.divided_pixels_per_clock = pixels}).cycles;
  };
  const std::uint64_t pixels = std::uint64_t{made.trace.width} * made.trace.height;
  EXPECT_NEAR(static_cast<double>(cycles(1) - cycles(2)), static_cast<double>(pixels) / 2, 1);
  EXPECT_GT(cycles(0), 100 * cycles(4)) << "the host reads byte by byte";
}

// As in the simulation.
TEST(Throughput, ATextureThatNoProgramSamplesCostsNothing) {
  RandomTrace made = testing::simple_trace(10);
  made.trace.programs[2].text = "ps_1_1\nmov r0, v0\n";
  const auto cycles = [&] {
    return estimate_throughput(made.trace, made.work, machine::load(machine::kGeForce4)).cycles;
  };
  const Cycle bound = cycles();
  std::get<Draw>(made.trace.commands[1]).texture.reset();
  EXPECT_EQ(bound, cycles());
}

TEST(Throughput, NoWorkTakesNoTime) {
  const Result result = estimate_throughput({}, {}, Machine{});
  EXPECT_EQ(result.cycles, 0u);
  EXPECT_EQ(result.seconds_of(0), 0);
  EXPECT_EQ(result.share(0), 0);
  EXPECT_EQ(result.frames_per_second(), 0);
  EXPECT_EQ(result.frames_per_second(0), 0);
}

// The same units, under the same names, are there and left out.
TEST(Throughput, KnowsTheUnitsThatATraceNeeds) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::RandomMaker maker(seed);
    const RandomTrace made = maker.trace();
    const Machine machine = maker.machine();
    const Result estimate = estimate_throughput(made.trace, made.work, machine);
    const Result simulated = simulate(made.trace, made.work, machine);
    ASSERT_EQ(estimate.units.size(), simulated.units.size());
    for (std::size_t i = 0; i < estimate.units.size(); ++i) {
      EXPECT_EQ(estimate.units[i].name, simulated.units[i].name);
      EXPECT_EQ(estimate.units[i].busy + estimate.units[i].starved, estimate.cycles);
    }
    EXPECT_EQ(estimate.units_left_out, simulated.units_left_out);
  }
}

// Quads that fail go no further, and hold no place of the depth test's queue.
TEST(Throughput, QuadsThatFailTheDepthTestPassNoQueue) {
  RandomTrace made = textured();
  DrawWork& work = made.work[0];
  work.texel_blocks.clear();
  std::size_t quad = 0;
  for (TriangleWork& triangle : work.triangles) {
    triangle.quads_passed = 0;
    for (std::uint32_t i = 0; i < triangle.quad_count; ++i, ++quad) {
      const bool passed = i == 0;
      work.quads[quad].passed = passed ? 15 : 0;
      work.quads[quad].texel_block_count = passed ? 1 : 0;
      triangle.quads_passed += passed;
      if (passed) work.texel_blocks.push_back(0);
    }
  }
  Machine machine = machine::load(machine::kGeForce4);
  for (const char* setting : {"vertex.units=16", "depth.queue=4", "depth.latency=200"})
    machine::assign(machine, setting);
  const auto estimate = static_cast<double>(estimate_throughput(made.trace, made.work, machine).cycles);
  const auto simulated = static_cast<double>(simulate(made.trace, made.work, machine).cycles);
  EXPECT_NEAR(estimate / simulated, 1, 0.05);
}

// Where all depends on the corner, a vertex runs all of it four times.
TEST(Throughput, WhatIfAVertexRunsAllOfItForEachCorner) {
  const Machine machine = machine::load(machine::kGeForce4);
  const RandomTrace made = testing::simple_trace(4000);
  const auto vertex_clocks = [&](const WhatIf& what_if) {
    const Result result = estimate_throughput(made.trace, made.work, machine, what_if);
    return static_cast<double>(std::ranges::find(result.units, "vertex0", &UnitBooks::name)->busy);
  };
  isa::Program program = load_program(made.trace.programs[1]);
  const double once = clocks_per_vertex(program, machine.vertex);
  const std::vector<isa::Instruction> body = program.instructions;
  for (int corner = 1; corner < 4; ++corner)
    program.instructions.insert(program.instructions.end(), body.begin(), body.end());
  const std::vector<std::uint32_t> everything(made.trace.programs.size(), ~0u);
  EXPECT_NEAR(vertex_clocks({.corner_inputs = everything}) / vertex_clocks({}),
              clocks_per_vertex(program, machine.vertex) / 4 / once, 0.01);
}

}  // namespace
}  // namespace splatscope::sim
