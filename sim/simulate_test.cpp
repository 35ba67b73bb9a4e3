#include "sim/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "model/command/load_program.h"
#include "model/error.h"
#include "model/testing/error_of.h"
#include "sim/testing/random_trace.h"
#include "sim/testing/same_books.h"
#include "sim/units/vertex/vertex_clocks.h"

namespace splatscope::sim {
namespace {

using testing::expect_same_books;
using testing::RandomMaker;
using testing::RandomTrace;
using testing::simple_trace;

std::uint64_t statistic(const Result& result, std::string_view unit, std::string_view name) {
  for (const UnitStatistic& entry : result.statistics) {
    if (entry.unit_name == unit && entry.name == name) return entry.value;
  }
  ADD_FAILURE() << "no statistic " << unit << "." << name;
  return 0;
}

const UnitBooks* books_of(const Result& result, std::string_view unit) {
  for (const UnitBooks& books : result.units) {
    if (books.name == unit) return &books;
  }
  return nullptr;
}

// Of what was left out: the units.
std::vector<std::string> units_without(const Result& result) {
  std::vector<std::string> names;
  for (const UnitLeftOut& entry : result.units_left_out) {
    if (std::ranges::count(entry.name, ' ') == 0) names.push_back(entry.name);
  }
  return names;
}

class RandomTraces : public ::testing::TestWithParam<unsigned> {};

// Draws go past units that they do not use, so it is the same whether these are there.
TEST_P(RandomTraces, UnitsThatNoDrawNeedsChangeNothing) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  RandomMaker maker(GetParam());
  const RandomTrace made = maker.trace();
  const Machine machine = maker.machine();
  const Result needed = simulate(made.trace, made.work, machine);
  const Result all = simulate(made.trace, made.work, machine, Scheduler::skip_ahead, {}, {}, UnitChoice::all);
  EXPECT_TRUE(units_without(all).empty());
  EXPECT_EQ(all.units.size(), needed.units.size() + units_without(needed).size());
  EXPECT_EQ(all.cycles, needed.cycles);
  EXPECT_EQ(all.event_hash, needed.event_hash);
  EXPECT_EQ(all.command_ends, needed.command_ends);
  for (const UnitBooks& books : needed.units) {
    expect_same_books(*books_of(all, books.name), books);
  }
  for (const std::string& name : units_without(needed)) EXPECT_EQ(books_of(all, name)->busy, 0u) << name;
  for (const UnitStatistic& s : needed.statistics)
    EXPECT_EQ(statistic(all, s.unit_name, s.name), s.value) << s.unit_name << "." << s.name;
}

TEST_P(RandomTraces, EveryItemOfTheWorkIsDoneOnce) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  RandomMaker maker(GetParam());
  const RandomTrace made = maker.trace();
  const Result result = simulate(made.trace, made.work, maker.machine());
  std::uint64_t vertices = 0, triangles = 0, quads = 0;
  for (const DrawWork& work : made.work) {
    vertices += work.shaded_vertices.size();
    triangles += work.triangles.size();
    quads += work.quads.size();
  }
  EXPECT_EQ(statistic(result, "vertex_fetch", "vertices"), vertices);
  EXPECT_EQ(statistic(result, "vertex_fetch", "indices"), 3 * triangles);
  EXPECT_EQ(statistic(result, "primitive", "assembled") + statistic(result, "primitive", "rejected"),
            triangles);
  EXPECT_EQ(statistic(result, "raster", "quads"), quads);
  EXPECT_EQ(result.command_ends.size(), made.trace.commands.size());
  EXPECT_TRUE(std::is_sorted(result.command_ends.begin(), result.command_ends.end()));
  if (!result.command_ends.empty()) {
    EXPECT_EQ(result.command_ends.back(), result.cycles);
  }
  EXPECT_EQ(result.frame_cycles.size(), frame_ends(made.trace).size());
  EXPECT_EQ(std::accumulate(result.frame_cycles.begin(), result.frame_cycles.end(), Cycle{0}), result.cycles);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTraces, ::testing::Range(1u, 51u));

TEST(Simulate, TheSameRunTwiceInAProcessIsTheSame) {
  const RandomTrace made = simple_trace(200);
  const Machine machine = machine::load(machine::kGeForce4);
  const Result first = simulate(made.trace, made.work, machine);
  for (int i = 0; i < 3; ++i) {
    const Result again = simulate(made.trace, made.work, machine);
    EXPECT_EQ(again.event_hash, first.event_hash);
    EXPECT_EQ(again.cycles, first.cycles);
  }
  EXPECT_GT(first.cycles, 0u);
  EXPECT_NEAR(first.seconds, static_cast<double>(first.cycles) / 275e6, 1e-6 * first.seconds);
}

// A frame costs the same wherever it stands, but for the caches, which are empty at first.
TEST(Simulate, EachFrameOfATraceHasItsCycles) {
  RandomTrace made = simple_trace(200);
  made.trace.commands.emplace_back(Present{});
  const Result alone = simulate(made.trace, made.work, machine::load(machine::kGeForce4));
  const Command clear = made.trace.commands[0], draw = made.trace.commands[1];
  made.trace.commands = {clear, draw, Present{}, clear, draw, Present{}, clear, draw, Present{}};
  made.work = {made.work[0], made.work[0], made.work[0]};
  for (std::size_t i = 0; i < 3; ++i) made.work[i].command = static_cast<std::uint32_t>(3 * i + 1);
  const Result three = simulate(made.trace, made.work, machine::load(machine::kGeForce4));
  ASSERT_EQ(three.frame_cycles.size(), 3u);
  EXPECT_EQ(alone.frame_cycles, std::vector<Cycle>{alone.cycles});
  for (const Cycle cycles : three.frame_cycles) {
    EXPECT_NEAR(static_cast<double>(cycles), static_cast<double>(alone.cycles),
                0.05 * static_cast<double>(alone.cycles));
  }
  EXPECT_NEAR(three.frames_per_second(), alone.frames_per_second(), 0.05 * alone.frames_per_second());
}

TEST(Simulate, VertexBoundDrawsTakeTheScheduledClocksAVertex) {
  const Machine machine = machine::load(machine::kGeForce4);
  const RandomTrace small = simple_trace(200), large = simple_trace(1200);
  const Result a = simulate(small.trace, small.work, machine);
  const Result b = simulate(large.trace, large.work, machine);
  const double clocks = clocks_per_vertex(load_program(small.trace.programs[1]), machine.vertex);
  // Start and end of the draw cancel, but for a vertex of the one unit that the other does not have.
  EXPECT_NEAR(static_cast<double>(b.cycles - a.cycles), 3000 * clocks / machine.vertex.units, 60);
}

TEST(Simulate, UnitsThatNoDrawNeedsAreLeftOut) {
  RandomTrace made = simple_trace(10);
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  const Machine machine = machine::load(machine::kRadeon8500);
  const Result all = simulate(made.trace, made.work, machine);
  EXPECT_NE(books_of(all, "texture"), nullptr);
  EXPECT_EQ(units_without(all), std::vector<std::string>{"agp"});

  draw.state.color_write = false;
  for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
  made.work[0].texel_blocks.clear();
  const Result depth_only = simulate(made.trace, made.work, machine);
  for (const char* name : {"texture", "pixel", "blend", "agp"})
    EXPECT_EQ(books_of(depth_only, name), nullptr) << name;
  EXPECT_EQ(units_without(depth_only).size(), 4u);
  EXPECT_NE(books_of(depth_only, "depth"), nullptr);

  draw.state.depth_test = draw.state.depth_write = false;
  EXPECT_EQ(books_of(simulate(made.trace, made.work, machine), "depth"), nullptr);
}

// A texture that the pixel program does not sample is as none.
TEST(Simulate, ATextureThatNoProgramSamplesCostsNothing) {
  RandomTrace made = simple_trace(10);
  for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
  made.work[0].texel_blocks.clear();
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  const Machine machine = machine::load(machine::kGeForce4);
  const auto result = [&] { return simulate(made.trace, made.work, machine); };
  const Cycle sampled = result().cycles;
  made.trace.programs[2].text = "ps_1_1\nmov r0, v0\n";
  const Result bound = result();
  draw.texture.reset();
  EXPECT_EQ(bound.cycles, result().cycles);
  EXPECT_LT(bound.cycles, sampled);
  EXPECT_EQ(units_without(bound), (std::vector<std::string>{"agp", "texture"}));
}

// The first vertex unit is busy wherever there is work at all.
TEST(Simulate, VertexUnitsAreBusyWhereAllOfThemAre) {
  Result result;
  const auto busiest = [&](Cycle agp, Cycle vertex1) {
    result.units.clear();
    for (const auto& [name, busy] :
         {std::pair("vertex_fetch", Cycle{10}), {"vertex0", 99}, {"vertex1", vertex1}, {"agp", agp}}) {
      UnitBooks& books = result.units.emplace_back();
      books.name = name;
      books.busy = busy;
    }
    return result.bottleneck();
  };
  EXPECT_EQ(busiest(98, 53).unit, "agp");
  EXPECT_EQ(busiest(98, 53).busy, 98u);
  EXPECT_EQ(busiest(98, 53).vertex_units, 0u);
  EXPECT_EQ(busiest(52, 53).unit, "vertex0");
  EXPECT_EQ(busiest(52, 53).busy, 53u);
  EXPECT_EQ(busiest(52, 53).vertex_units, 2u);
}

TEST(Simulate, ASecondVertexUnitHalvesAVertexBoundDraw) {
  const RandomTrace made = simple_trace(1200);
  Machine machine = machine::load(machine::kGeForce4);
  machine.vertex.units = 1;
  const Result one = simulate(made.trace, made.work, machine);
  machine.vertex.units = 2;
  const Result two = simulate(made.trace, made.work, machine);
  const auto draw_cycles = [](const Result& result) {
    return static_cast<double>(result.command_ends[1] - result.command_ends[0]);
  };
  EXPECT_NEAR(draw_cycles(one) / draw_cycles(two), 2.0, 0.1);  // fill and drain do not halve
}

TEST(Simulate, VerticesOverAgpTakeTheBus) {
  RandomTrace made = simple_trace(400);
  const Machine machine = machine::load(machine::kGeForce4);
  const Result video = simulate(made.trace, made.work, machine);
  made.trace.buffers[0].place = MemoryPlace::agp;
  std::get<Draw>(made.trace.commands[1]).vertex_stride = 256;
  const Result agp = simulate(made.trace, made.work, machine);
  EXPECT_GT(agp.cycles, video.cycles);
  // 1200 vertices of 256 bytes at 16 bytes a bus clock of 4.125 core cycles.
  EXPECT_EQ(statistic(agp, "agp", "data_clocks"), 1200u * 16u);
  EXPECT_GE(agp.cycles, static_cast<Cycle>(1200 * 16 * 4.125));
}

// The host rewrites all colours, so a draw behind it reads them all again; behind a Present it does not.
TEST(Simulate, ColoursThatTheHostRewroteAreReadAgain) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::assign(machine, "blend.cache_lines=1024");
  const auto misses = [&](const Command& between) {
    RandomTrace made = simple_trace(200);
    std::get<Draw>(made.trace.commands[1]).state.blend = true;
    const Command draw = made.trace.commands[1];
    made.trace.commands = {Clear{}, draw, between, draw};
    made.work.push_back(made.work[0]);
    made.work[1].command = 3;
    return statistic(simulate(made.trace, made.work, machine), "blend", "misses");
  };
  const auto once = misses(Present{});
  EXPECT_GT(once, 0u);
  EXPECT_EQ(misses(NormalizeOnHost{}), 2 * once);
}

TEST(Simulate, WorkThatDoesNotFitTheTraceIsABug) {
  RandomTrace made = simple_trace(10);
  const Machine machine;
  EXPECT_THROW(simulate(made.trace, {}, machine), ModelError);
  made.work[0].quads.pop_back();
  EXPECT_THROW(simulate(made.trace, made.work, machine), ModelError);
  made = testing::simple_trace(1);
  simulate(made.trace, made.work, machine);
  made.work[0].samples_only = true;
  EXPECT_THROW(simulate(made.trace, made.work, machine), ModelError);
}

TEST(Simulate, WorkThatFailsToComeEndsTheRun) {
  const RandomTrace made = simple_trace(10);
  const PartSource broken = []() -> const DrawWork& { throw UserError("x", 0, "broken"); };
  EXPECT_THROW(simulate_beside(made.trace, broken, Machine{}), UserError);
  EXPECT_GT(simulate(made.trace, made.work, Machine{}).cycles, 0u);  // and the next one is not disturbed
}

TEST(Simulate, AProgramThatDoesNotLoadIsAUsersError) {
  RandomTrace made = simple_trace(10);
  made.trace.programs[1].text = "vs_1_1\nmoo r0, v0\n";
  EXPECT_THROW(simulate(made.trace, made.work, Machine{}), UserError);
}

TEST(Simulate, ATimeThatCannotBeCountedIsAUsersError) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "host.command_nanoseconds=1e9");
  Trace clears;
  clears.width = clears.height = 4;
  clears.commands.assign(18'001, Clear{});
  EXPECT_TRUE(
      error_of([&] {
        simulate(clears, {}, machine);
      }).starts_with("trace: the host alone takes 5.0003 hours of the machine's time, for 18001 commands"));
  clears.commands.resize(18'000);
  EXPECT_EQ(error_of([&] { expect_countable_time(clears, machine); }), "no error");

  machine = machine::load(machine::kGeForce4);
  machine::set(machine, "host.uncached_read_nanoseconds=1e6");
  machine::set(machine, "numbers.frame=float32");
  Trace pixels;
  pixels.width = pixels.height = 4096;
  pixels.commands = {NormalizeOnHost{}};
  EXPECT_TRUE(
      error_of([&] {
        simulate(pixels, {}, machine);
      }).starts_with("trace: the host alone takes 74.5660 hours of the machine's time, for 1 commands"));
  pixels.width = 1;
  EXPECT_EQ(error_of([&] { expect_countable_time(pixels, machine); }), "no error");
}

TEST(Simulate, BuffersThatTheRowsSpreadBeyondAllAddressesAreAUsersError) {
  Machine machine = machine::load(machine::kGeForce4);
  for (const char* value : {"memory.row_bytes=65536", "memory.banks=64", "memory.channels=16"})
    machine::set(machine, value);
  Trace trace;
  trace.width = trace.height = 4;
  trace.buffers.resize(60, {MemoryPlace::video, std::vector<std::byte>(1)});
  EXPECT_EQ(error_of([&] { lay_out(trace, machine); }), "no error");
  trace.buffers.resize(70, trace.buffers[0]);
  EXPECT_EQ(
      error_of([&] { lay_out(trace, machine); }),
      "trace: its surfaces, textures and buffers do not fit into 4 GiB, as each begins a row of all banks "
      "and channels, 67108864 bytes, expected a smaller memory.row_bytes, memory.banks or "
      "memory.channels");
}

// What the host does is just countable, and the clears are not.
TEST(Simulate, ARunEndsWhereItsTimeCannotBeCounted) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "host.command_nanoseconds=1e9");
  machine::set(machine, "clock.core_megahertz=1");
  Trace clears;
  clears.width = clears.height = 64;
  clears.commands.assign(18'000, Clear{});
  EXPECT_TRUE(error_of([&] {
                simulate(clears, {}, machine);
              }).starts_with("trace: takes more than 5 hours of the machine's time"));
}

// SystemC counts the femtoseconds of all runs of a process in 64 bits.
TEST(Simulate, RunsThatTakeMoreThanFiveHoursTogetherAreAsEachAlone) {
  Machine machine = machine::load(machine::kGeForce4);
  const RandomTrace made = simple_trace(1000);
  const Result alone = simulate(made.trace, made.work, machine);
  Machine slow_host = machine;
  machine::set(slow_host, "host.command_nanoseconds=1e9");
  Trace clears;
  clears.width = clears.height = 4;
  clears.commands.assign(9'000, Clear{});  // two and a half hours
  const Cycle long_one = simulate(clears, {}, slow_host).cycles;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(simulate(clears, {}, slow_host).cycles, long_one);
  const Result after = simulate(made.trace, made.work, machine);
  EXPECT_EQ(after.event_hash, alone.event_hash);
  EXPECT_EQ(after.cycles, alone.cycles);
}

TEST(Simulate, ProgressGrowsToOne) {
  const RandomTrace made = simple_trace(10000);
  std::vector<double> seen;
  simulate(made.trace, made.work, machine::load(machine::kGeForce4), Scheduler::skip_ahead,
           [&](double done) { seen.push_back(done); });
  EXPECT_GE(seen.size(), 3u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
}

// Between two draws into a surface one samples it: the caches are written back before, so that lines which
// the second draw touches again are written once more.
TEST(Simulate, ASampledSurfaceIsInMemory) {
  RandomTrace made = simple_trace(4);
  made.trace.surfaces = 1;
  Draw into = std::get<Draw>(made.trace.commands[1]);
  into.target = 1;
  into.state.depth_test = into.state.depth_write = false;
  Draw from = into;
  from.target = 0;
  from.texture.reset();
  from.source = 1;
  made.trace.commands = {Clear{}, into, from, into};
  std::set<std::uint32_t> lines;
  for (const QuadWork& quad : made.work[0].quads) lines.insert(quad.y / 2u * 16 + quad.x / 2u);
  made.work.resize(3, made.work[0]);
  for (std::uint32_t i = 0; i < 3; ++i) made.work[i].command = i + 1;
  Machine machine;
  machine.blend.cache_lines = machine.blend.cache_ways = 64;
  const Result result = simulate(made.trace, made.work, machine);
  EXPECT_EQ(statistic(result, "blend", "write_backs"), 3 * lines.size());
  made.trace.commands = {Clear{}, into, into, into};
  EXPECT_EQ(statistic(simulate(made.trace, made.work, machine), "blend", "write_backs"), lines.size());
}

// A clear is of the frame: what the cache holds of a surface stays, and is written.
TEST(Simulate, AClearLeavesTheLinesOfSurfacesAlone) {
  RandomTrace made = simple_trace(4);
  made.trace.surfaces = 1;
  Machine machine;
  machine.blend.cache_lines = machine.blend.cache_ways = 64;
  const auto write_backs = [&](std::uint32_t target) {
    std::get<Draw>(made.trace.commands[1]).target = target;
    return statistic(simulate(made.trace, made.work, machine), "blend", "write_backs");
  };
  made.trace.commands.emplace_back(Clear{});
  EXPECT_EQ(write_backs(0), 0u);
  EXPECT_GT(write_backs(1), 0u);
}

// The host reads and writes as many bytes a pixel as the frame has: of float32 four times those of UNORM8.
TEST(Simulate, TheHostsTimeGoesByTheBytesOfAPixel) {
  Trace trace;
  trace.width = trace.height = 64;
  trace.commands = {NormalizeOnHost{}};
  const auto cycles = [&](FrameFormat format) {
    Machine machine;
    machine.numbers.frame = format;
    machine.clock.core_megahertz = machine.clock.bus_megahertz = 100;
    machine.host.uncached_read_bytes = machine.host.write_bytes_per_clock = 4;
    machine.host.uncached_read_nanoseconds = 70;
    return simulate(trace, {}, machine).cycles;
  };
  // Three more reads of 7 clocks and three more clocks of writing.
  EXPECT_EQ(cycles(FrameFormat::float32) - cycles(FrameFormat::unorm8), 64u * 64 * 3 * (7 + 1));
}

TEST(Simulate, SurfacesTexturesAndBuffersLieApart) {
  Trace trace;
  trace.width = trace.height = 64;
  trace.surfaces = 2;
  trace.textures.resize(2);
  for (Texture& texture : trace.textures) {
    texture.width = texture.height = 100;
    texture.texels.resize(10000);
  }
  trace.buffers.resize(4, {MemoryPlace::video, std::vector<std::byte>(70000)});
  trace.buffers[1].place = trace.buffers[3].place = MemoryPlace::agp;
  const MemoryLayout layout = lay_out(trace, machine::load(machine::kGeForce4));
  using Part = std::pair<std::uint64_t, std::uint64_t>;  // address, bytes
  std::vector<Part> video{{layout.color_address, std::uint64_t{layout.color.bytes()} * 3},
                          {layout.depth_address, layout.depth.bytes()}};
  std::vector<Part> agp;
  for (const std::uint32_t address : layout.textures) video.emplace_back(address, 10000);
  for (std::size_t i = 0; i < 4; ++i) (i % 2 ? agp : video).emplace_back(layout.buffers[i], 70000);
  for (std::vector<Part>* parts : {&video, &agp}) {
    std::ranges::sort(*parts);
    for (std::size_t i = 1; i < parts->size(); ++i)
      EXPECT_LE((*parts)[i - 1].first + (*parts)[i - 1].second, (*parts)[i].first) << i;
  }
}

TEST(Simulate, ADepthBufferOf16BitsIsHalfAsLarge) {
  Trace trace;
  trace.width = trace.height = 64;
  Machine machine;
  machine.numbers.depth = DepthFormat::z24;
  EXPECT_EQ(lay_out(trace, machine).depth.bytes(), 64u * 64 * 4);
  machine.numbers.depth = DepthFormat::z16;
  EXPECT_EQ(lay_out(trace, machine).depth.bytes(), 64u * 64 * 2);
}

// What the depth cache holds is of the depths before the clear, and need not be written.
TEST(Simulate, AClearEmptiesTheDepthCache) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::assign(machine, "depth.cache_lines=1024");
  RandomTrace made = simple_trace(200);
  const Command clear = made.trace.commands[0], draw = made.trace.commands[1];
  const Result once = simulate(made.trace, made.work, machine);
  made.trace.commands = {clear, draw, clear, draw};
  made.work.push_back(made.work[0]);
  made.work[1].command = 3;
  const Result twice = simulate(made.trace, made.work, machine);
  EXPECT_GT(statistic(once, "depth", "misses"), 0u);
  EXPECT_EQ(statistic(twice, "depth", "misses"), 2 * statistic(once, "depth", "misses"));
  EXPECT_EQ(statistic(twice, "depth", "write_backs"), statistic(once, "depth", "write_backs"));
}

// The cache numbers the lines of a draw's texture: those of another one are no hits.
TEST(Simulate, EachDrawReadsItsTextureAnew) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::assign(machine, "texture.cache_lines=4096");
  RandomTrace made = simple_trace(200);
  const Result once = simulate(made.trace, made.work, machine);
  made.trace.textures.push_back(made.trace.textures[0]);
  Draw other = std::get<Draw>(made.trace.commands[1]);
  other.texture = 1;
  made.trace.commands.emplace_back(other);
  made.work.push_back(made.work[0]);
  made.work[1].command = 2;
  const Result twice = simulate(made.trace, made.work, machine);
  EXPECT_EQ(statistic(twice, "texture", "misses"), 2 * statistic(once, "texture", "misses"));
}

}  // namespace
}  // namespace splatscope::sim
