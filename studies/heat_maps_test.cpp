#include "studies/heat_maps.h"

#include <gtest/gtest.h>

#include <numeric>

#include "studies/run.h"
#include "studies/run_results.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kScene =
    "surfels = { columns = 24, rows = 20 }\nframe = { width = 70, height = 45 }\ncapture.views = 1\n"
    "camera = { eye = [0, 14, -20], target = [0, 0, 0] }\nsplatting.algorithm = ";

double sum_of(const HeatMap& map) {
  return std::accumulate(map.image.pixels.begin(), map.image.pixels.end(), 0.0);
}

// A sum is equal to the counter that results.json has; the frame's size is no multiple of a tile's nor a
// quad's.
TEST(HeatMaps, SumsAreTheCounters) {
  const Machine machine = machine::load(machine::kGeForce4);
  for (const char* algorithm : {"\"ewa-per-surfel\"", "\"ewa-per-pixel\""}) {
    const traces::Scene scene = traces::parse_scene(std::string(kScene) + algorithm + "\n", "small.toml");
    const Trace trace = traces::record(scene, machine.numbers).trace;
    HeatMaps heat(trace, true);
    sim::Observer* const observers[] = {heat.observer()};
    const FrameRun run =
        run_frame(trace, machine, Fidelity::cycle, {}, {}, {.observers = observers, .heat_maps = &heat});
    ASSERT_EQ(4u, run.heat_maps.size());
    const RenderCounters& c = run.rendered.counters;
    std::uint64_t lookups = 0;
    for (const sim::UnitStatistic& s : run.timing->statistics)
      if (s.unit_name == "texture" && s.name == "lookups") lookups = s.value;
    const sim::UnitBooks& raster = *std::ranges::find(run.timing->units, "raster", &sim::UnitBooks::name);
    const std::uint64_t expected[] = {c.fragments, c.fragments - c.fragments_passed, lookups,
                                      raster.busy + raster.starved + raster.blocked};
    for (std::size_t i = 0; i < 4; ++i) {
      const HeatMap& map = run.heat_maps[i];
      EXPECT_GT(expected[i], 0u) << map.name;
      EXPECT_EQ(expected[i], map.sum) << map.name;
      EXPECT_EQ(static_cast<double>(expected[i]), sum_of(map)) << map.name;
      const Image image = colored(map);
      EXPECT_GE(image.width, 70);
      EXPECT_LT(image.width, 70 + map.scale);
    }
    Input input;
    input.trace = trace;
    const auto maps = results_of(input, machine, Fidelity::cycle, run)["heat_maps"];
    EXPECT_EQ(maps[0]["counter"], "fragments");
    EXPECT_EQ(maps[2]["counter"], "texture.lookups");
    // The picture and the time are those of a run without.
    const FrameRun plain = run_frame(trace, machine, Fidelity::cycle);
    EXPECT_EQ(plain.timing->event_hash, run.timing->event_hash);
    // Without cycles the first three are the same.
    HeatMaps counted(trace, false);
    const FrameRun functional =
        run_frame(trace, machine, Fidelity::functional, {}, {}, {.heat_maps = &counted});
    EXPECT_FALSE(functional.timing);
    ASSERT_EQ(3u, functional.heat_maps.size());
    const auto uncounted = results_of(input, machine, Fidelity::functional, functional)["heat_maps"];
    EXPECT_EQ(uncounted[0]["counter"], "fragments");
    EXPECT_FALSE(uncounted[2].contains("counter")) << "no unit counted";
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(run.heat_maps[i].image.pixels, functional.heat_maps[i].image.pixels);
  }
}

// Three pixels of the quad right of the one in the corner: all but the lower right one, of which the upper
// left one passes.
TEST(HeatMaps, APixelIsCountedWhereItLies) {
  Trace trace;
  trace.width = 4;
  trace.height = 4;
  HeatMaps heat(trace, false);
  DrawWork work;
  work.quads = {{.x = 1, .y = 0, .covered = 0b0111, .passed = 0b0001, .texel_block_count = 3}};
  heat.add(work);
  const std::vector<HeatMap> maps = heat.maps();
  EXPECT_EQ(maps[0].image.pixels, (std::vector<float>{0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(maps[1].image.pixels, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(maps[2].image.pixels, (std::vector<float>{0, 3, 0, 0}));
}

// Half of the way from ln 1 to ln 100 is ln 10; each count fills as many pixels as it stands for.
TEST(HeatMaps, ColoursGoByTheLogarithmOfOneMore) {
  HeatMap map;
  map.scale = 2;
  map.image = {3, 1, {0, 9, 99}};
  const Image image = colored(map);
  ASSERT_EQ(image.width, 6);
  ASSERT_EQ(image.height, 2);
  constexpr float kExpected[][3] = {{0, 0, 0.02f}, {0.74f, 0.22f, 0.33f}, {0.99f, 1, 0.64f}};
  for (int x = 0; x < 6; ++x) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(image.at(x, 0)[c], kExpected[x / 2][c], 1e-5) << x;
      EXPECT_EQ(image.at(x, 1)[c], image.at(x, 0)[c]) << x;
    }
  }
}

}  // namespace
}  // namespace splatscope::studies
