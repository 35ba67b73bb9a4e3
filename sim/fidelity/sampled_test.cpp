#include "sim/fidelity/sampled.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "model/error.h"
#include "sim/fidelity/thinning.h"
#include "sim/testing/cutter.h"
#include "sim/testing/random_trace.h"
#include "sim/testing/same_books.h"

namespace splatscope::sim {
namespace {

using testing::RandomTrace;

// One draw of splats whose size, texels and place drift along it and scatter: two triangles of a quad each,
// of `least` pixel quads or more.
RandomTrace splats(std::uint32_t triangles, unsigned seed, std::uint32_t least = 2) {
  std::mt19937 random(seed);
  const auto number = [&](std::uint32_t least, std::uint32_t most) {
    return std::uniform_int_distribution<std::uint32_t>(least, most)(random);
  };
  RandomTrace made = testing::simple_trace(0);
  made.trace.width = made.trace.height = 256;
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  DrawWork& work = made.work[0];
  draw.index_count = 3 * triangles;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    TriangleWork triangle;
    triangle.new_vertices = i % 2 == 0 ? 3 : 1;
    for (std::uint32_t k = 0; k < triangle.new_vertices; ++k)
      work.shaded_vertices.push_back(i / 2 * 4 + (i % 2 == 0 ? k : 3));
    const std::uint32_t drift = 8 * i / triangles;  // from small splats to large ones
    triangle.quad_count = number(drift + least, drift + least + 4);
    triangle.tile_count = 1 + triangle.quad_count / 8;
    const std::uint32_t x = number(0, 127), y = 120 * i / triangles;
    for (std::uint32_t k = 0; k < triangle.quad_count; ++k) {
      QuadWork quad;
      quad.x = static_cast<std::uint16_t>((x + k % 4) % 128);
      quad.y = static_cast<std::uint16_t>(y + k / 4);
      quad.covered = 15;
      quad.passed = number(0, 3) == 0 ? 0 : 15;
      quad.texel_block_count = quad.passed ? 1 : 0;
      triangle.quads_passed += quad.passed != 0;
      if (quad.passed) work.texel_blocks.push_back(number(0, 255));
      work.quads.push_back(quad);
    }
    work.triangles.push_back(triangle);
  }
  return made;
}

struct FrameOfSplats {
  std::uint32_t triangles;
  std::uint32_t least = 2;
};

// Frames of a large draw and a small one, all of one state.
RandomTrace frames_of_two_draws(const std::vector<FrameOfSplats>& frames, std::uint32_t small) {
  RandomTrace made = splats(0, 1);
  made.trace.commands.clear();
  made.work.clear();
  for (const auto [large, least] : frames) {
    made.trace.commands.emplace_back(Clear{});
    for (const std::uint32_t triangles : {large, small}) {
      const RandomTrace draw = splats(triangles, 7, least);
      made.work.push_back(draw.work[0]);
      made.work.back().command = static_cast<std::uint32_t>(made.trace.commands.size());
      made.trace.commands.push_back(draw.trace.commands[1]);
    }
    made.trace.commands.emplace_back(Present{});
  }
  return made;
}

void expect_books_to_add_up(const Result& result) {
  for (const UnitBooks& unit : result.units)
    EXPECT_EQ(unit.busy + unit.starved + unit.blocked + unit.idle, result.cycles) << unit.name;
}

constexpr std::uint32_t kTriangles = 40000;

// One run, without a second one where that was too little.
SampledRun sample_once(const RandomTrace& made, const Machine& machine, const Sampling& sampling) {
  auto next = made.work.begin();
  return estimate_sampled_beside(
      made.trace, [&]() -> const DrawWork& { return *next++; }, machine, sampling);
}

Result sample(const RandomTrace& made, const Machine& machine, const Sampling& sampling) {
  return sample_once(made, machine, sampling).result;
}

// Over seeds 1 to kSeeds: how often the interval covers the truth, and the mean of the errors, which is what
// the samples have in common.
constexpr int kSeeds = 10;
struct OverSeeds {
  int covered = 0;
  double bias = 0;  // of the cycles
};
template <typename Look>
OverSeeds over_seeds(const RandomTrace& made, const Machine& machine, const std::vector<double>& density,
                     const Result& truth, Look look) {
  const auto cycles = static_cast<double>(truth.cycles);
  OverSeeds out;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Result sampled = sample(made, machine, {seed, density});
    const double error = static_cast<double>(sampled.cycles) - cycles;
    out.bias += error / cycles / kSeeds;
    out.covered += std::abs(error) <= sampled.cycles_plus_minus;
    look(sampled);
  }
  return out;
}

struct Bottleneck {
  std::vector<std::string> settings;
  double density = 4;  // of samples
};
class Machines : public ::testing::TestWithParam<Bottleneck> {};

// Each in its own bottleneck: vertices, memory, memory without reordering, setup, setup behind a queue that
// takes long to fill, texture lookups.
TEST_P(Machines, TheIntervalCoversTheTruthAndIsNarrow) {
  Machine machine = machine::load(machine::kGeForce4);
  for (const std::string& setting : GetParam().settings) machine::set(machine, setting);
  const RandomTrace made = splats(kTriangles, 7);
  const Result truth = simulate(made.trace, made.work, machine);
  const auto cycles = static_cast<double>(truth.cycles);
  const auto [covered, bias] =
      over_seeds(made, machine, {GetParam().density}, truth, [&](const Result& sampled) {
        EXPECT_GT(sampled.cycles_plus_minus, 0);
        EXPECT_LE(sampled.cycles_plus_minus, 0.065 * cycles);  // 100 samples that scatter by a quarter
        ASSERT_EQ(sampled.units.size(), truth.units.size());
        expect_books_to_add_up(sampled);
        for (std::size_t i = 0; i < truth.units.size(); ++i) {
          const UnitBooks& a = sampled.units[i];
          EXPECT_EQ(a.name, truth.units[i].name);
          EXPECT_NEAR(static_cast<double>(a.busy), static_cast<double>(truth.units[i].busy), 0.05 * cycles)
              << a.name;
        }
      });
  EXPECT_GE(covered, 9);            // 19 of 20 are promised
  EXPECT_LE(std::abs(bias), 0.01);  // the mean of 10: what the samples have in common
}

INSTANTIATE_TEST_SUITE_P(Bottlenecks, Machines,
                         ::testing::Values(Bottleneck{}, Bottleneck{{"memory.channels=1"}},
                                           Bottleneck{{"memory.channels=1", "memory.bypass_limit=0"}},
                                           Bottleneck{{"setup.clocks_per_triangle=40"}},
                                           Bottleneck{{"setup.clocks_per_triangle=40", "primitive.queue=512"},
                                                      1},
                                           Bottleneck{{"vertex.units=8", "texture.lookups_per_clock=1",
                                                       "texture.cache_lines=16"}}));

class SmallDraws : public ::testing::TestWithParam<std::uint32_t> {};

// A draw that is all start and end has nothing to leave out, and perhaps no end or no start.
TEST_P(SmallDraws, MayStandBesideASampledOne) {
  const RandomTrace made = frames_of_two_draws({{25000}}, GetParam());
  const Machine machine = machine::load(machine::kGeForce4);
  const Result truth = simulate(made.trace, made.work, machine);
  const Result sampled = sample(made, machine, {1, {3}});
  EXPECT_GT(sampled.cycles_plus_minus, 0);
  EXPECT_LE(sampled.cycles_plus_minus, 0.1 * static_cast<double>(truth.cycles));
  EXPECT_NEAR(static_cast<double>(sampled.cycles), static_cast<double>(truth.cycles),
              sampled.cycles_plus_minus);
  expect_books_to_add_up(sampled);
}

INSTANTIATE_TEST_SUITE_P(Triangles, SmallDraws, ::testing::Values(0U, 1U, 64U, 127U, 128U, 129U, 256U, 320U));

// Equal ones, whose samples must lie in different places, and unlike ones, as progressive frames are: few and
// small splats, many, large ones.
TEST(Sampled, EveryFrameAndAllTogetherLieInTheirIntervals) {
  const Machine machine = machine::load(machine::kGeForce4);
  for (const std::vector<FrameOfSplats>& frames :
       {std::vector<FrameOfSplats>{{25000}, {25000}, {25000}},
        std::vector<FrameOfSplats>{{5000}, {28000, 1}, {50000}, {30000, 12}}}) {
    const RandomTrace made = frames_of_two_draws(frames, 128);
    const Result truth = simulate(made.trace, made.work, machine);
    std::vector<int> frames_covered(frames.size());
    const std::vector<double> density(frames.size(), 3);
    const auto [covered, bias] = over_seeds(made, machine, density, truth, [&](const Result& sampled) {
      ASSERT_EQ(sampled.frame_cycles.size(), frames.size());
      EXPECT_LE(sampled.cycles_plus_minus, 0.1 * static_cast<double>(truth.cycles));
      for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_LE(sampled.frame_plus_minus[i], sampled.cycles_plus_minus);
        const double error =
            static_cast<double>(sampled.frame_cycles[i]) - static_cast<double>(truth.frame_cycles[i]);
        frames_covered[i] += std::abs(error) <= sampled.frame_plus_minus[i];
      }
    });
    EXPECT_GE(covered, 9) << "seeds 1 to 10";
    for (std::size_t i = 0; i < frames.size(); ++i)
      EXPECT_GE(frames_covered[i], 9) << "frame " << i << ", seeds 1 to 10";
  }
}

// Of draws that are alike, whose samples must not fall in step with them; memory is about as fast as what
// feeds the queues, so that these fill late: the start of a draw says nothing of its middle.
TEST(Sampled, ManyDrawsAlikeLieInTheirInterval) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "vertex.units=3");
  RandomTrace made = splats(4000, 7);
  for (std::uint32_t copy = 1; copy < 47; ++copy) {
    made.trace.commands.push_back(made.trace.commands[1]);
    made.work.push_back(made.work[0]);
    made.work.back().command = copy + 1;
  }
  const Result truth = simulate(made.trace, made.work, machine);
  const auto [covered, bias] = over_seeds(made, machine, {1}, truth, [&](const Result& sampled) {
    EXPECT_LE(sampled.cycles_plus_minus, 0.1 * static_cast<double>(truth.cycles));
  });
  EXPECT_GE(covered, 9) << "seeds 1 to 10";
  EXPECT_LE(std::abs(bias), 0.01);
}

TEST(Sampled, TheSeedAloneDecidesWhichSamplesAreTaken) {
  const RandomTrace made = splats(kTriangles, 7);
  const Machine machine = machine::load(machine::kRadeon8500);
  const Result one = sample(made, machine, {1});
  EXPECT_EQ(one.cycles, sample(made, machine, {1}).cycles);
  EXPECT_NE(one.cycles, sample(made, machine, {2}).cycles);
  ASSERT_EQ(one.command_ends.size(), 2u);
  EXPECT_LT(one.command_ends[0], one.command_ends[1]);
  EXPECT_EQ(one.command_ends[1], one.cycles);
}

// The setup unit alone is the bottleneck: its samples are all alike, and few of them say all.
TEST(Sampled, WhereOneUnitExplainsTheTimeFewSamplesAreEnough) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "setup.clocks_per_triangle=60");
  const RandomTrace made = splats(kTriangles, 7);
  const auto [first, density] = sample_once(made, machine, {1});
  EXPECT_TRUE(density.empty());
  EXPECT_GT(first.cycles_plus_minus, 0);
  EXPECT_EQ(estimate_sampled(made.trace, made.work, machine, 1).cycles, first.cycles);
}

// It is that of most stretches, and memory of the last ones: what a few samples say of these is chance, also
// where they are all alike.
TEST(Sampled, WhereTwoUnitsAreAsSlowASecondRunTakesMore) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "setup.clocks_per_triangle=32");
  const RandomTrace made = splats(kTriangles, 7);
  const Result truth = simulate(made.trace, made.work, machine);
  const auto cycles = static_cast<double>(truth.cycles);
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [first, density] = sample_once(made, machine, {seed});
    const Result result = estimate_sampled(made.trace, made.work, machine, seed);
    ASSERT_EQ(density.size(), 1u);
    EXPECT_GE(density[0] * (kTriangles / 64.0 / 24), 80);
    EXPECT_EQ(result.cycles, sample(made, machine, {seed, density}).cycles);
    EXPECT_TRUE(sample_once(made, machine, {seed, {1}}).density.empty()) << "that was a second run";
    EXPECT_LE(result.cycles_plus_minus, 0.025 * cycles);  // what was asked for, from few samples
    covered += std::abs(static_cast<double>(result.cycles) - cycles) <= result.cycles_plus_minus;
  }
  EXPECT_GE(covered, 9);
}

// Vertices all over a buffer: a line of memory is read for each, where a stretch is expected to read their
// bytes alone.
TEST(Sampled, WhereNoUnitExplainsTheTimeASecondRunTakesMore) {
  Machine machine = machine::load(machine::kGeForce4);
  for (const char* setting : {"memory.channels=1", "vertex.units=8"}) machine::set(machine, setting);
  RandomTrace made = splats(kTriangles, 7);
  DrawWork& work = made.work[0];
  std::mt19937 random(7);
  for (std::uint32_t& vertex : work.shaded_vertices) vertex = random() % 65536;
  work.texel_blocks.clear();
  work.quads.resize(work.triangles.size());
  for (std::size_t i = 0; i < work.triangles.size(); ++i) {
    work.quads[i] = {1, 1, 15, 15, 0};
    work.triangles[i].tile_count = work.triangles[i].quad_count = work.triangles[i].quads_passed = 1;
  }
  const auto [first, density] = sample_once(made, machine, {1});
  EXPECT_LE(first.cycles_plus_minus, kPrecision * static_cast<double>(first.cycles)) << "they are alike";
  EXPECT_EQ(density.size(), 1u);
}

TEST(Sampled, WhereSamplesWouldBeMostOfItAllIsSimulated) {
  const RandomTrace made = splats(kTriangles, 7);
  const Machine machine = machine::load(machine::kGeForce4);
  EXPECT_GT(sample(made, machine, {}).cycles_plus_minus, 0);
  const Result result = estimate_sampled(made.trace, made.work, machine);
  EXPECT_EQ(result.cycles_plus_minus, 0);
  testing::expect_same_times(result, simulate(made.trace, made.work, machine));
}

TEST(Sampled, ADensityIsThatOfItsFrame) {
  const Machine machine = machine::load(machine::kGeForce4);
  const RandomTrace made = frames_of_two_draws({{25000}, {25000}, {25000}}, 128);
  const Result thin = sample(made, machine, {});
  const Result denser = sample(made, machine, {1, {1, 4, 1}});
  EXPECT_EQ(denser.frame_cycles[0], thin.frame_cycles[0]) << "the same samples";
  EXPECT_LT(denser.frame_plus_minus[1], 0.7 * thin.frame_plus_minus[1]);
  EXPECT_GT(denser.frame_plus_minus[2], 0.7 * thin.frame_plus_minus[2]);
}

// Nothing to sample: exactly what the simulation says, clears and the host too.
TEST(Sampled, SmallTracesAreSimulatedWhole) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::RandomMaker maker(seed);
    const RandomTrace made = maker.trace();
    const Machine machine = maker.machine();
    const Result sampled = estimate_sampled(made.trace, made.work, machine);
    const Result simulated = simulate(made.trace, made.work, machine);
    EXPECT_EQ(sampled.cycles_plus_minus, 0);
    testing::expect_same_times(sampled, simulated);
    EXPECT_EQ(sampled.units_left_out, simulated.units_left_out);
  }
}

// In parts, each in the place of the one before it, also of frames that are sampled.
TEST(Sampled, WorkThatComesAsItIsNeededGivesTheSame) {
  RandomTrace made = frames_of_two_draws({{kTriangles, 1}, {kTriangles, 4}}, 500);
  for (DrawWork& work : made.work) work.sampled_runs_apart = 4;
  const Machine machine = machine::load(machine::kGeForce4);
  const Result at_once = sample(made, machine, {3});
  EXPECT_GT(at_once.cycles_plus_minus, 0);
  for (const std::size_t most : {1, 100, 10000}) {
    testing::Cutter cutter(made.work, most, 1);
    std::vector<double> told;
    const auto [beside, density] = estimate_sampled_beside(
        made.trace, [&]() -> const DrawWork& { return cutter.next(); }, machine, {.seed = 3},
        [&](double fraction) { told.push_back(fraction); });
    EXPECT_TRUE(cutter.is_at_the_end());
    EXPECT_EQ(told, (std::vector<double>{0, 0.25, 0.5, 0.75}));
    EXPECT_EQ(beside.cycles_plus_minus, at_once.cycles_plus_minus);
    testing::expect_same_times(beside, at_once);
    expect_books_to_add_up(beside);
  }
}

TEST(Sampled, WorkThatDoesNotFitTheTraceIsABug) {
  RandomTrace made = splats(100, 7);
  EXPECT_THROW(estimate_sampled(made.trace, {}, Machine{}), ModelError);
  const PartSource broken = []() -> const DrawWork& { throw UserError("x", 0, "broken"); };
  EXPECT_THROW(estimate_sampled_beside(made.trace, broken, Machine{}), UserError);
  const DrawWork whole = made.work[0];
  made.work[0].quads.pop_back();
  EXPECT_THROW(estimate_sampled(made.trace, made.work, Machine{}), ModelError);
  made.work[0] = {};
  EXPECT_THROW(estimate_sampled(made.trace, made.work, Machine{}), ModelError);
  made.work[0] = splats(99, 7).work[0];
  EXPECT_THROW(estimate_sampled(made.trace, made.work, Machine{}), ModelError) << "one triangle too few";
  made.work[0] = whole;
  made.work.push_back(made.work[0]);
  EXPECT_THROW(estimate_sampled(made.trace, made.work, Machine{}), ModelError);
}

// Has still to look at all of a draw.
class Keeper final : public DrawUnit {
 public:
  using DrawUnit::DrawUnit;
  Step advance(Cycle) override { return idle(); }
  std::uint64_t items(const DrawJob&) const override { return 1; }
  std::uint64_t cuts_passed(const DrawJob& job) const override { return cuts_passed_by_tags(job); }
};

// However it is cut: the units see what is kept, and behind which of it all else was left out.
TEST(ThinParts, KeepSpansOfADrawAndWhatLiesBetween) {
  const RandomTrace made = splats(1000, 3);
  const DrawWork& all = made.work[0];
  for (const std::size_t most : {1, 100, 10000}) {
    testing::Cutter cutter(made.work, most, 1);
    const PartSource next = [&]() -> const DrawWork& { return cutter.next(); };
    DrawJob job;
    job.draw = &std::get<Draw>(made.trace.commands[1]);
    job.command = 1;
    Completion completion;
    const Keeper keeper("keeper", completion);
    const std::array<const DrawUnit*, 1> units{&keeper};
    ThinParts thin(next, units);
    thin.begin(job, {{0, 64}, {64, 128}, {512, 1000}}, nullptr);
    while (!job.is_complete()) thin.take();
    EXPECT_TRUE(cutter.is_at_the_end());
    EXPECT_EQ(job.all_triangles, 128u + 488u);
    std::size_t vertices = 0, quads = 0, blocks = 0, kept_vertices = 0, kept_quads = 0, kept_blocks = 0;
    std::vector<std::uint32_t> left_vertices, left_blocks;
    std::vector<QuadWork> left_quads;
    for (std::uint64_t i = 0; i < job.cuts->end(); ++i) {
      const Cut& cut = (*job.cuts)[i];
      left_vertices.insert(left_vertices.end(), cut.vertices.begin(), cut.vertices.end());
      left_quads.insert(left_quads.end(), cut.quads.begin(), cut.quads.end());
      left_blocks.insert(left_blocks.end(), cut.blocks.begin(), cut.blocks.end());
    }
    std::size_t left_vertex = 0, left_quad = 0, left_block = 0;
    for (std::size_t triangle = 0; triangle < all.triangles.size(); ++triangle) {
      const bool is_kept = triangle < 128 || triangle >= 512;
      for (std::size_t n = all.triangles[triangle].new_vertices; n != 0; --n, ++vertices)
        EXPECT_EQ(is_kept ? job.shaded_vertices[kept_vertices++] : left_vertices[left_vertex++],
                  all.shaded_vertices[vertices]);
      for (std::size_t n = all.triangles[triangle].quad_count; n != 0; --n, ++quads) {
        const QuadWork& quad = is_kept ? job.quads[kept_quads++] : left_quads[left_quad++];
        EXPECT_EQ(quad.x, all.quads[quads].x);
        for (std::size_t k = quad.texel_block_count; k != 0; --k, ++blocks)
          EXPECT_EQ(is_kept ? job.texel_blocks[kept_blocks++] : left_blocks[left_block++],
                    all.texel_blocks[blocks]);
      }
      if (triangle != 127) continue;
      for (std::uint64_t i = 0; i < job.cuts->end(); ++i) {
        EXPECT_EQ((*job.cuts)[i].vertex, kept_vertices);
        EXPECT_EQ((*job.cuts)[i].quad, kept_quads);
      }
    }
    EXPECT_EQ(left_vertex, left_vertices.size());
    EXPECT_EQ(left_quad, left_quads.size());
    EXPECT_EQ(left_block, left_blocks.size());
  }
}

}  // namespace
}  // namespace splatscope::sim
