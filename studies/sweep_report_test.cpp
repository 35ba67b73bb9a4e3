#include "studies/sweep_report.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace splatscope::studies {
namespace {

// On a machine with these settings, frames of so many cycles at 1 MHz.
SweepPoint point(std::vector<std::pair<std::string, std::string>> settings, const std::vector<int>& cycles) {
  SweepPoint out{.settings = std::move(settings), .results = {}, .rate = {}};
  double all = 0;
  for (const int count : cycles) {
    out.results["frames"].push_back(
        {{"cycles", count}, {"milliseconds", count / 1e3}, {"frames_per_second", 1e6 / count}});
    all += count;
  }
  out.rate = {static_cast<double>(cycles.size()) * 1e6 / all, "vertex0", 0.5};
  out.cycles = static_cast<std::uint64_t>(all);
  return out;
}

Sweep two_by_two() {
  Sweep sweep;
  sweep.points.push_back(point({{"vertex.units", "1"}, {"memory.channels", "4"}}, {1000, 3000}));
  sweep.points.push_back(point({{"vertex.units", "1"}, {"memory.channels", "2"}}, {2000, 6000}));
  sweep.points.push_back(point({{"vertex.units", "2"}, {"memory.channels", "4"}}, {500, 500}));
  sweep.points.push_back(point({{"vertex.units", "2"}, {"memory.channels", "2"}}, {1000, 1000}));
  return sweep;
}

TEST(SweepReport, TheTableHasALineForEachFrameOfEachMachine) {
  EXPECT_EQ(
      csv_of(two_by_two()),
      "vertex.units,memory.channels,frame,cycles,cycles_plus_minus,milliseconds,frames_per_second,bottleneck,"
      "bottleneck_busy_share\n"
      "1,4,0,1000,,1,1000,,\n"
      "1,4,1,3000,,3,333.3333333333333,,\n"
      "1,2,0,2000,,2,500,,\n"
      "1,2,1,6000,,6,166.66666666666666,,\n"
      "2,4,0,500,,0.5,2000,,\n"
      "2,4,1,500,,0.5,2000,,\n"
      "2,2,0,1000,,1,1000,,\n"
      "2,2,1,1000,,1,1000,,\n");
  Sweep one_frame = two_by_two();
  one_frame.points.resize(1);
  one_frame.points[0].results["frames"].erase(1);
  EXPECT_TRUE(csv_of(one_frame).ends_with("\n1,4,0,1000,,1,1000,vertex0,0.5\n")) << csv_of(one_frame);
}

TEST(SweepReport, AnIntervalStandsBesideItsCycles) {
  Sweep sampled = two_by_two();
  sampled.points.resize(1);
  sampled.points[0].results["frames"].erase(1);
  sampled.points[0].results["frames"][0]["cycles_plus_minus"] = 12.5;
  sampled.points[0].cycles = 1000;
  sampled.points[0].cycles_plus_minus = 12.5;
  EXPECT_TRUE(csv_of(sampled).ends_with("\n1,4,0,1000,12.5,1,1000,vertex0,0.5\n")) << csv_of(sampled);
  const std::string html = report_of(sampled, machine::load(machine::kGeForce4), Fidelity::sampled).html();
  EXPECT_NE(html.find("1000 ± 12"), std::string::npos);
}

TEST(SweepReport, ACurveForEachCombinationOverTheLastParameterInItsOrder) {
  const auto plot = plot_of(two_by_two());
  ASSERT_TRUE(plot);
  EXPECT_EQ(plot->x_label, "memory.channels");
  ASSERT_EQ(plot->series.size(), 2u);
  EXPECT_EQ(plot->series[0].name, "vertex.units = 1");
  EXPECT_EQ(plot->series[0].x, (std::vector<double>{2, 4}));
  EXPECT_EQ(plot->series[0].y, (std::vector<double>{250, 500}));
  EXPECT_EQ(plot->series[1].name, "vertex.units = 2");
  EXPECT_EQ(plot->series[1].y, (std::vector<double>{1000, 2000}));
}

TEST(SweepReport, NoCurveWhereTheyWouldBeTooManyOrValuesAreNoNumbers) {
  Sweep many, words;
  for (int i = 0; i < 9; ++i) {
    many.points.push_back(point({{"vertex.units", std::to_string(i)}, {"memory.channels", "1"}}, {1000}));
    EXPECT_EQ(plot_of(many).has_value(), i < 8) << i;
  }
  words.points.push_back(point({{"memory.fast_clear", "true"}}, {1000}));
  EXPECT_FALSE(plot_of(words));
  const std::string html = report_of(words, machine::load(machine::kGeForce4), Fidelity::cycle).html();
  EXPECT_NE(html.find("No curves: "), std::string::npos);
}

TEST(SweepReport, ThePageAddsTheFramesOfAMachineUp) {
  const std::string html = report_of(two_by_two(), machine::load(machine::kGeForce4), Fidelity::cycle).html();
  EXPECT_NE(html.find("8000"), std::string::npos);
  EXPECT_NE(html.find("vertex0 (50 % busy)"), std::string::npos);
  EXPECT_NE(html.find("image/svg+xml"), std::string::npos);
}

TEST(SweepReport, ThePageSaysWhatWasChanged) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "vertex.threads=1");
  machine::set(machine, "numbers.frame=half");
  Sweep sweep = two_by_two();
  sweep.replaced = {"program splat.ps replaced by red.ps (1 slots, was 2)"};
  const std::string html = report_of(sweep, machine, Fidelity::cycle).html();
  EXPECT_NE(
      html.find("fidelity cycle. At all points numbers.frame = half, vertex.threads = 1. Changed: program "
                "splat.ps replaced by red.ps (1 slots, was 2)."),
      std::string::npos);
}

TEST(SweepReport, ThePageDoesWithoutAPlotter) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "", 1);
  const std::string html = report_of(two_by_two(), machine::load(machine::kGeForce4), Fidelity::cycle).html();
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_NE(html.find("No curves of "), std::string::npos);
  EXPECT_NE(html.find("gnuplot failed"), std::string::npos);
  EXPECT_NE(html.find("vertex0 (50 % busy)"), std::string::npos);
}

}  // namespace
}  // namespace splatscope::studies
