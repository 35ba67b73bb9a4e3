#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim/observe/tile_cycles.h"
#include "sim/observe/time_series.h"
#include "sim/observe/timeline.h"
#include "sim/testing/random_trace.h"

namespace splatscope::sim {
namespace {

using testing::RandomMaker;
using testing::RandomTrace;
using Json = nlohmann::json;

struct Observed {
  Result plain, result;
  std::string timeline, series;
  Cycle cut_at = 0;
};

const UnitBooks& books_of(const Result& result, const std::string& unit) {
  const auto books = std::ranges::find(result.units, unit, &UnitBooks::name);
  if (books == result.units.end()) throw std::runtime_error("no unit " + unit);
  return *books;
}

constexpr unsigned kSeeds[] = {7, 11, 12, 20};  // of traces with draws

Observed observe(unsigned seed, const LogWindow& window, Cycle interval = 100) {
  RandomMaker maker(seed);
  const RandomTrace made = maker.trace();
  const Machine machine = maker.machine();
  std::ostringstream timeline_text, series_text;
  Timeline timeline(timeline_text, made.trace, window);
  TimeSeries series(series_text, interval);
  Observer* const observers[] = {&timeline, &series};
  Observed out;
  out.plain = simulate(made.trace, made.work, machine);
  out.result = simulate(made.trace, made.work, machine, Scheduler::skip_ahead, {}, observers);
  out.timeline = timeline_text.str();
  out.series = series_text.str();
  out.cut_at = timeline.cut_at();
  return out;
}

// The slices of each track by the track's name, and within it the cycles by the slice's name.
std::map<std::string, std::map<std::string, Cycle>> cycles_of(const std::string& timeline) {
  const Json events = Json::parse(timeline).at("traceEvents");
  std::map<int, std::string> tracks;
  for (const Json& event : events) {
    if (event.at("name") == "thread_name") tracks[event.at("tid")] = event.at("args").at("name");
  }
  std::map<std::string, std::map<std::string, Cycle>> cycles;
  for (const Json& event : events) {
    if (event.at("ph") == "X")
      cycles[tracks.at(event.at("tid"))][event.at("name")] += event.at("dur").get<Cycle>();
  }
  return cycles;
}

TEST(Observe, ChangesNothing) {
  for (const unsigned seed : kSeeds) {
    const Observed run = observe(seed, {});
    EXPECT_GT(books_of(run.plain, "raster").busy, 0u) << "seed " << seed << " draws nothing";
    EXPECT_EQ(run.plain.event_hash, run.result.event_hash) << "seed " << seed;
    EXPECT_EQ(run.plain.cycles, run.result.cycles) << "seed " << seed;
  }
}

TEST(Timeline, SlicesAddUpToTheBooks) {
  const Observed run = observe(7, {});
  auto cycles = cycles_of(run.timeline);
  Cycle commands = 0;
  for (const auto& [name, sum] : cycles.at("commands")) commands += sum;
  EXPECT_EQ(run.result.cycles, commands);
  for (const UnitBooks& books : run.result.units) {
    EXPECT_EQ(books.busy, cycles[books.name]["busy"]) << books.name;
    EXPECT_EQ(books.starved, cycles[books.name]["starved"]) << books.name;
    for (const auto& [by, sum] : books.blocked_by) {
      EXPECT_EQ(sum, cycles[books.name]["blocked by " + by]) << books.name;
    }
  }
}

// The Trace Event Format (Google, "Trace Event Format", 2016): an object with `traceEvents`, whose events
// have a phase, a process and what that phase needs. Perfetto also wants the slices of a track not to
// overlap.
TEST(Timeline, IsATraceEventFile) {
  const Json file = Json::parse(observe(7, {}).timeline);
  ASSERT_TRUE(file.is_object());
  EXPECT_TRUE(file.at("displayTimeUnit") == "ms" || file.at("displayTimeUnit") == "ns");
  std::map<std::string, std::size_t> phases;
  std::map<int, Cycle> ends;  // of the last slice of each track
  for (const Json& event : file.at("traceEvents")) {
    const std::string phase = event.at("ph");
    ++phases[phase];
    EXPECT_TRUE(event.at("name").is_string());
    EXPECT_TRUE(event.at("pid").is_number_integer());
    if (phase == "M") {
      const std::string& name = event.at("name").get_ref<const std::string&>();
      const Json& value = event.at("args").at(name == "thread_sort_index" ? "sort_index" : "name");
      EXPECT_TRUE(name == "thread_sort_index" ? value.is_number_integer() : value.is_string()) << event;
      EXPECT_TRUE(name == "process_name" || event.at("tid").is_number_integer());
    } else if (phase == "X") {
      EXPECT_TRUE(event.at("ts").is_number_unsigned());
      EXPECT_GT(event.at("dur").get<Cycle>(), 0u);
      Cycle& end = ends[event.at("tid").get<int>()];
      EXPECT_GE(event.at("ts").get<Cycle>(), end) << event;
      end = event.at("ts").get<Cycle>() + event.at("dur").get<Cycle>();
    } else {
      ASSERT_EQ("C", phase) << event;
      EXPECT_TRUE(event.at("ts").is_number_unsigned());
      ASSERT_EQ(1u, event.at("args").size());
      EXPECT_TRUE(event.at("args").begin()->is_number());
    }
  }
  EXPECT_GT(phases["M"], 10u);
  EXPECT_GT(phases["X"], 10u);
  EXPECT_GT(phases["C"], 10u);
}

TEST(Timeline, ShowsTheWindowAlone) {
  const Observed all = observe(7, {});
  const Cycle first = all.result.cycles / 4, last = all.result.cycles / 2;
  const Json events = Json::parse(observe(7, {.first = first, .last = last}).timeline).at("traceEvents");
  std::size_t shown = 0;
  for (const Json& event : events) {
    if (!event.contains("ts")) continue;
    ++shown;
    EXPECT_GE(event.at("ts").get<Cycle>(), first);
    EXPECT_LE(event.at("ts").get<Cycle>() + event.value("dur", Cycle{1}), last + 1);
  }
  EXPECT_GT(shown, 10u);
  EXPECT_LT(shown, Json::parse(all.timeline).at("traceEvents").size());
  auto tracks = cycles_of(observe(7, {.first = first, .last = last}).timeline);
  Cycle commands = 0;  // they follow each other without a gap
  for (const auto& [name, sum] : tracks.at("commands")) commands += sum;
  EXPECT_EQ(last - first + 1, commands);
}

TEST(Timeline, EndsWellWhereItIsCutShort) {
  const Observed run = observe(7, {.most_bytes = 4000});
  EXPECT_LT(run.cut_at, run.result.cycles);
  const auto cycles = cycles_of(run.timeline);
  EXPECT_TRUE(cycles.contains("commands"));
  EXPECT_EQ(kNever, observe(7, {}).cut_at);
}

// Also of what goes on there, and is known later.
TEST(Timeline, ShowsAllThatWasBeforeItWasCutShort) {
  for (std::uint64_t bytes = 20000; bytes <= 40000; bytes += 200) {
    const Observed cut = observe(7, {.most_bytes = bytes});
    ASSERT_LT(cut.cut_at, cut.result.cycles);
    ASSERT_GT(cut.cut_at, 0u);
    auto shown = cycles_of(cut.timeline), wanted = cycles_of(observe(7, {.last = cut.cut_at - 1}).timeline);
    shown.erase("commands");  // whole
    wanted.erase("commands");
    EXPECT_EQ(shown, wanted) << bytes << " bytes";
  }
}

std::string timeline_of(const RandomTrace& made, const LogWindow& window) {
  std::ostringstream text;
  Timeline timeline(text, made.trace, window);
  Observer* const observers[] = {&timeline};
  simulate(made.trace, made.work, Machine{}, Scheduler::skip_ahead, {}, observers);
  return text.str();
}

// A trace may name its programs so; JSON is UTF-8.
TEST(Timeline, ANameMayHoldAnyBytes) {
  RandomTrace made = testing::simple_trace(20);
  for (ShaderText& program : made.trace.programs) program.name = "\"caf\xe9\"\n";
  EXPECT_TRUE(cycles_of(timeline_of(made, {})).at("commands").contains("draw: \"caf\xef\xbf\xbd\"\n"));
}

TEST(Timeline, LongNamesAndManyCommandsDoNotMakeItLonger) {
  RandomTrace made = testing::simple_trace(2);
  for (ShaderText& program : made.trace.programs) {
    program.name.clear();
    for (int i = 0; i < 10000; ++i) program.name += "x\xc3\xa9";
  }
  const std::vector<Command> once = made.trace.commands;
  const std::vector<DrawWork> work = made.work;
  for (std::uint32_t copy = 1; copy < 100; ++copy) {
    made.trace.commands.insert(made.trace.commands.end(), once.begin(), once.end());
    for (DrawWork draw : work) {
      draw.command += copy * static_cast<std::uint32_t>(once.size());
      made.work.push_back(std::move(draw));
    }
  }
  const std::string empty = timeline_of(made, {.most_bytes = 0});
  const std::string text = timeline_of(made, {.most_bytes = 10000});
  EXPECT_LE(text.size(), empty.size() + 10000);
  const auto cycles = cycles_of(text);
  EXPECT_GT(cycles.size(), 1u);  // tracks: of units too
  ASSERT_TRUE(cycles.contains("commands"));
  for (const auto& [name, sum] : cycles.at("commands")) {
    EXPECT_LE(name.size(), 203u);
    EXPECT_EQ(name.find("\xef\xbf\xbd"), std::string::npos) << name;
  }
}

using Table = std::vector<std::vector<std::string>>;

Table table_of(const std::string& series) {
  std::istringstream in(series);
  Table rows;
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    EXPECT_EQ(rows.front().size(), rows.back().size());
  }
  return rows;
}

TEST(TimeSeries, RowsAddUpToTheResult) {
  const Observed run = observe(11, {}, 50);
  const Table rows = table_of(run.series);
  ASSERT_GT(rows.size(), 3u);
  EXPECT_EQ(std::to_string(run.result.cycles), rows.back().front());
  const auto sum = [&](const std::string& column, bool shares) {
    const auto at = static_cast<std::size_t>(std::ranges::find(rows.front(), column) - rows.front().begin());
    double total = 0, before = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double cycle = std::stod(rows[i].front());
      total += std::stod(rows[i].at(at)) * (shares ? cycle - before : 1);
      before = cycle;
    }
    return total;
  };
  // Shares are printed with six digits.
  EXPECT_NEAR(static_cast<double>(books_of(run.result, "raster").busy), sum("raster.busy", true),
              1e-5 * static_cast<double>(run.result.cycles));
  for (const UnitStatistic& statistic : run.result.statistics) {
    EXPECT_EQ(static_cast<double>(statistic.value), sum(statistic.unit_name + "." + statistic.name, false));
  }
}

// A reader of the table, or of a timeline's counters, finds columns by name.
TEST(TimeSeries, ColumnsHaveNamesOfTheirOwn) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::string series = observe(seed, {}, 1000).series;
    std::istringstream header(series.substr(0, series.find('\n')));
    std::set<std::string> names;
    for (std::string name; std::getline(header, name, ',');)
      EXPECT_TRUE(names.insert(name).second) << name << ", seed " << seed;
  }
}

TEST(TimeSeries, RowsEndAtMultiplesOfTheInterval) {
  const Observed run = observe(11, {}, 50);
  const Table rows = table_of(run.series);
  ASSERT_EQ(rows.size(), 1 + (run.result.cycles + 49) / 50);
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) EXPECT_EQ(rows[i].front(), std::to_string(50 * i));
}

// Transfers are booked ahead, and counted when the data moves.
TEST(TimeSeries, NoDataBusIsBusyForLongerThanARow) {
  for (const unsigned seed : kSeeds) {
    const Observed run = observe(seed, {}, 4);
    const Table rows = table_of(run.series);
    double before = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double length = std::stod(rows[i].front()) - before;
      before += length;
      for (std::size_t k = 0; k < rows[i].size(); ++k) {
        if (!rows.front()[k].starts_with("memory") || !rows.front()[k].ends_with(".data_clocks")) continue;
        EXPECT_LE(std::stod(rows[i][k]), length) << "seed " << seed << ", cycle " << rows[i].front();
      }
    }
    const Json timeline = Json::parse(run.timeline);
    for (const Json& event : timeline.at("traceEvents")) {
      if (event.at("ph") != "C" || !event.at("name").get<std::string>().ends_with("data bus")) continue;
      for (const auto& [name, value] : event.at("args").items()) EXPECT_LE(value.get<int>(), 100) << name;
    }
  }
}

// A value holds from its event to the next: what the buses carried, less what is cut off a per cent.
TEST(Timeline, TheSharesOfABusAddUpToItsDataClocks) {
  for (const unsigned seed : kSeeds) {
    const Observed run = observe(seed, {});
    const auto end = static_cast<double>(run.result.cycles);
    std::map<std::string, double> carried, share, since;
    const auto hold = [&](const std::string& bus, double until) {
      carried[bus] += share[bus] / 100 * (until - since[bus]);
      since[bus] = until;
    };
    const Json timeline = Json::parse(run.timeline);
    for (const Json& event : timeline.at("traceEvents")) {
      const std::string name = event.at("name");
      if (event.at("ph") != "C" || !name.ends_with(" data bus")) continue;
      hold(name, event.at("ts"));
      share[name] = event.at("args").at("% busy");
    }
    for (const UnitStatistic& statistic : run.result.statistics) {
      if (!statistic.unit_name.starts_with("memory") || statistic.name != "data_clocks") continue;
      const std::string bus = statistic.unit_name + " data bus";
      hold(bus, end);
      EXPECT_LE(carried[bus], static_cast<double>(statistic.value) + 1e-6) << "seed " << seed;
      EXPECT_GE(carried[bus], static_cast<double>(statistic.value) - end / 100) << "seed " << seed;
    }
  }
}

// Cycles that are not visited change nothing: each row is what the referee sees, who visits all of them.
TEST(TimeSeries, TheRefereeWritesTheSameRows) {
  for (const unsigned seed : kSeeds) {
    for (const Cycle interval : {1, 7, 100}) {
      RandomMaker maker(seed);
      const RandomTrace made = maker.trace();
      const Machine machine = maker.machine();
      std::ostringstream series[2];
      for (const Scheduler scheduler : {Scheduler::skip_ahead, Scheduler::referee}) {
        TimeSeries rows(series[static_cast<int>(scheduler)], interval);
        Observer* const observers[] = {&rows};
        simulate(made.trace, made.work, machine, scheduler, {}, observers);
      }
      EXPECT_TRUE(series[0].str() == series[1].str()) << "seed " << seed << ", every " << interval;
    }
  }
}

TEST(TimeSeries, NoUnitIsBusyForLongerThanARow) {
  for (const unsigned seed : kSeeds) {
    const Table rows = table_of(observe(seed, {}, 4).series);
    for (std::size_t i = 1; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < rows[i].size(); ++k) {
        if (!rows.front()[k].ends_with(".busy")) continue;
        EXPECT_LE(std::stod(rows[i][k]), 1) << "seed " << seed << ", cycle " << rows[i].front();
      }
    }
  }
}

// Of two triangles, the first in the first tile and the other in the second one.
struct Tiles {
  Result result;
  std::vector<Cycle> cycles;
};
Tiles tiles_of(bool is_drawn, int draws, const Machine& machine, bool first_covers = true) {
  RandomTrace made = testing::simple_trace(2);
  for (std::uint16_t i = 0; i < 8; ++i) {
    made.work[0].quads[i].x = static_cast<std::uint16_t>(i < 4 ? 0 : 4);
    made.work[0].quads[i].y = 0;
  }
  Draw& draw = std::get<Draw>(made.trace.commands[1]);
  if (!is_drawn) {
    draw.state.depth_test = draw.state.depth_write = draw.state.color_write = false;
    draw.texture.reset();
    for (QuadWork& quad : made.work[0].quads) quad.texel_block_count = 0;
    made.work[0].texel_blocks.clear();
  }
  for (int i = 1; i < draws; ++i) {
    made.trace.commands.push_back(made.trace.commands[1]);
    made.work.push_back(made.work[0]);
    made.work.back().command = static_cast<std::uint32_t>(i + 1);
  }
  if (!first_covers) {
    DrawWork& first = made.work[0];
    first.quads.clear();
    first.texel_blocks.clear();
    for (TriangleWork& triangle : first.triangles) {
      triangle.outcome = TriangleOutcome::no_coverage;
      triangle.quad_count = triangle.quads_passed = 0;
    }
  }
  TileCycles tiles(made.trace.width, made.trace.height);
  Observer* const observers[] = {&tiles};
  Tiles out;
  out.result = simulate(made.trace, made.work, machine, Scheduler::skip_ahead, {}, observers);
  out.cycles = tiles.cycles();
  return out;
}

TEST(TileCycles, AreAllThatTheRasteriserWasNotIdle) {
  for (const bool is_drawn : {false, true}) {
    for (const bool first_covers : {false, true}) {
      const Tiles tiles = tiles_of(is_drawn, 3, machine::load(machine::kGeForce4), first_covers);
      const UnitBooks& raster = books_of(tiles.result, "raster");
      EXPECT_EQ(tiles.cycles[0] + tiles.cycles[1], raster.busy + raster.starved + raster.blocked)
          << is_drawn << first_covers;
    }
  }
}

// The second triangle comes 500 cycles after the first, and these are its tile's.
TEST(TileCycles, WaitingIsTheNextQuads) {
  Machine machine = machine::load(machine::kGeForce4);
  machine.setup.clocks_per_triangle = 500;
  const Tiles tiles = tiles_of(true, 1, machine);
  EXPECT_GE(tiles.cycles[1], 500u);
  EXPECT_LE(tiles.cycles[1], 510u);
}

}  // namespace
}  // namespace splatscope::sim
