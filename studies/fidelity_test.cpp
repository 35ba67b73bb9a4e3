#include "studies/fidelity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/testing/sanitized.h"
#include "model/testing/scratch_folder.h"
#include "studies/peak_memory.h"
#include "studies/run_results.h"

namespace splatscope::studies {
namespace {

TEST(FidelityStudy, EveryFidelityStandsBesideTheReferee) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 40\nrows = 40\n[frame]\nwidth = 96\nheight = 96\n"
      "[capture]\nviews = 2\nframe_size = 96\n",
      "plane");
  const std::vector<FidelityRow> rows = fidelity_rows(frame_of(scene), 1);
  ASSERT_EQ(10u, rows.size());
  for (const FidelityRow& row : rows) {
    SCOPED_TRACE(std::string(name(row.fidelity)) + " on " + row.machine);
    EXPECT_GT(row.host_seconds, 0);
    EXPECT_EQ(row.cycles == 0, row.fidelity == Fidelity::functional);
    EXPECT_EQ(row.units.empty(), row.fidelity == Fidelity::functional);
    EXPECT_LT(std::abs(row.error), 0.1);
    EXPECT_EQ(row.seeds.size(), row.fidelity == Fidelity::sampled ? 1u : 0u);
    for (const FidelityRow::Seed& seed : row.seeds) {
      EXPECT_EQ(seed.error, 0);
      EXPECT_TRUE(seed.covers());
    }
    if (row.fidelity == Fidelity::throughput) {
      EXPECT_NE(row.error, 0);
    }
    // This plane is too small to be sampled: it is simulated whole.
    if (row.fidelity > Fidelity::throughput) {
      EXPECT_EQ(row.error, 0);
      for (const auto& unit : row.units) EXPECT_EQ(unit.error, 0) << unit.unit;
    }
  }
}

traces::Scene small_plane() {
  return traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 20\nrows = 20\n[frame]\nwidth = 64\nheight = 64\n"
      "[capture]\nviews = 1\nframe_size = 64\n",
      "plane");
}

TEST(FidelityStudy, EachFrameOfATraceIsJudged) {
  const traces::Scene scene = small_plane();
  const auto twice = [&](const Machine& machine) {
    Trace trace = traces::record(scene, machine.numbers).trace;
    const std::vector<Command> again = trace.commands;
    trace.commands.push_back(Present{});
    trace.commands.insert(trace.commands.end(), again.begin(), again.end());
    return trace;
  };
  const std::vector<FidelityRow> rows = fidelity_rows({"plane", 64, twice}, 1);
  ASSERT_EQ(rows.size(), 20u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].scene, i % 2 == 0 ? "plane, frame 1" : "plane, frame 2");
    EXPECT_LT(std::abs(rows[i].error), 0.1);
    EXPECT_EQ(rows[i].seeds.size(), rows[i].fidelity == Fidelity::sampled ? 1u : 0u);
    if (rows[i].fidelity == Fidelity::cycle) {
      EXPECT_EQ(rows[i].error, 0);
    }
  }
  const std::vector<FidelityRow> alone = fidelity_rows(frame_of(scene), 1);
  EXPECT_NEAR(static_cast<double>(rows.back().cycles), static_cast<double>(alone.back().cycles),
              0.1 * static_cast<double>(alone.back().cycles));
  EXPECT_TRUE(fidelity_text({"Two", rows}).starts_with("Two, 4 frames against the referee\n"));
}

TEST(FidelityStudy, ATableIsSummedUp) {
  const traces::Scene scene = small_plane();
  const std::vector<FidelityRow> rows = fidelity_rows(frame_of(scene), 1);
  EXPECT_EQ(rows.back().fidelity, Fidelity::referee);
  EXPECT_EQ(rows.back().resolution, 64);
  const std::string text = fidelity_text({"Table 2", rows});
  EXPECT_TRUE(text.starts_with("Table 2, 2 frames against the referee\n")) << text;
  EXPECT_NE(text.find("covers 2 of 2\n"), std::string::npos) << text;
}

TEST(FidelityStudy, AnEstimateHasNoEventHash) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 8\nrows = 8\n[frame]\nwidth = 32\n"
      "height = 32\n[splatting]\nalgorithm = \"no-ewa\"\n",
      "plane");
  const Machine machine = machine::load(machine::kGeForce4);
  const Trace trace = traces::record(scene, machine.numbers).trace;
  for (const Fidelity fidelity :
       {Fidelity::throughput, Fidelity::sampled, Fidelity::cycle, Fidelity::referee}) {
    const auto frames = timing_json(*run_frame(trace, machine, fidelity).timing)["frames"];
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].contains("event_hash"), fidelity >= Fidelity::cycle) << name(fidelity);
  }
}

// The worst and the mean are of every seed, and so is the coverage.
TEST(FidelityStudy, SampledIsJudgedByEverySeed) {
  FidelityRow functional, sampled, cycle;
  sampled.fidelity = Fidelity::sampled;
  sampled.cycles = cycle.cycles = 1000;
  sampled.host_seconds = cycle.host_seconds = functional.host_seconds = 1;
  sampled.seeds = {{1000, 4, 0}, {1020, 21, 0.02}, {990, 8, -0.01}, {1010, 9, 0.01}};
  cycle.fidelity = Fidelity::cycle;
  const std::string text = fidelity_text({"Table 1", {functional, sampled, cycle}});
  EXPECT_NE(text.find(" 2.00 %      1.00 %"), std::string::npos) << text;
  EXPECT_NE(text.find("+- 1.04 % on average and 2.06 % at most, covers 2 of 4\n"), std::string::npos) << text;
}

// Fig. 3 is a depth image: its frames write no colour.
TEST(FidelityStudy, FiguresWithScenesOfTheirOwnAreDrawn) {
  const Machine machine = machine::load(machine::kGeForce4);
  std::vector<std::string> names;
  for (const FidelityFrame& frame : figure_frames()) {
    names.push_back(frame.scene);
    EXPECT_EQ(frame.resolution, 512);
    std::size_t draws = 0, of_colour = 0;
    for (const Command& command : frame.record(machine).commands) {
      const Draw* draw = std::get_if<Draw>(&command);
      if (draw == nullptr) continue;
      ++draws;
      of_colour += draw->state.color_write;
    }
    EXPECT_GT(draws, 0u) << frame.scene;
    EXPECT_EQ(of_colour == 0, frame.scene.starts_with("fig3")) << frame.scene;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"fig3-even", "fig3-uneven", "fig4", "fig5", "fig10-model",
                                             "fig10-sheet"}));
}

TEST(FidelityStudy, EveryGroupIsInTheReportAndInTheResults) {
  const ScratchFolder folder;
  std::vector<FidelityGroup> groups{{"Table 1", {}}, {"Figures", {}}};
  for (FidelityGroup& group : groups) {
    FidelityRow& row = group.rows.emplace_back();
    row.scene = std::string("a scene of ") + std::string(group.name);
    row.fidelity = Fidelity::cycle;
    row.cycles = 1000;
    row.host_seconds = 1;
  }
  Findings findings(folder.path(), "fidelity", "");
  add_fidelity_report(findings, groups);
  findings.write(1);
  const std::string report = text_of(folder / "report.html");
  const auto results = nlohmann::json::parse(text_of(folder / "results.json"))["fidelity"];
  ASSERT_EQ(results.size(), groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    EXPECT_NE(report.find(std::string(groups[i].name) + ", over all frames"), std::string::npos);
    EXPECT_NE(report.find(groups[i].rows[0].scene), std::string::npos);
    EXPECT_EQ(results[i]["scene"], groups[i].rows[0].scene);
  }
}

TEST(PeakMemory, GrowsWithWhatIsTakenAndStartsAgain) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer's own memory grows with the program's";
  if (!restart_peak_memory()) GTEST_SKIP() << "the system does not reset the peak";
  constexpr double kBatch = 4;  // MB: the system counts in batches of pages
  const double before = peak_megabytes();
  std::vector<char>(64'000'000, 1).back() = 2;
  EXPECT_NEAR(peak_megabytes(), before + 64, kBatch);
  ASSERT_TRUE(restart_peak_memory());
  EXPECT_NEAR(peak_megabytes(), before, kBatch);
}

}  // namespace
}  // namespace splatscope::studies
