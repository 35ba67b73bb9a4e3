#include "studies/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace splatscope::studies {
namespace {

TEST(Plot, DrawsEachSeriesUnderItsName) {
  Plot plot{
      .title = "it's \"quoted\" & $s0 `date`",
      .x_label = "x, mm",
      .y_label = "error",
      .log_x = true,
      .log_y = true,
      .series = {{"first", {1, 10, 100}, {0.1, 0.2, std::nan("")}, true}, {"second", {1, 2}, {3, 4}, false}}};
  const std::string svg = svg_of(plot);
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_NE(std::string::npos, svg.find("</svg>"));
  for (const char* text : {"first", "second", "x, mm", "error", "it's", "`date`"})
    EXPECT_NE(std::string::npos, svg.find(text)) << text;
}

// Of five points two make a curve and two another.
TEST(Plot, ACurveEndsWhereAValueIsMissing) {
  const auto drawing = [](double middle) {
    return svg_of({.title = "t",
                   .x_label = "x",
                   .y_label = "y",
                   .series = {{"s", {1, 2, 3, 4, 5}, {1, 2, middle, 2, 1}}}});
  };
  const auto moves = [](const std::string& svg) {
    const std::size_t curve = svg.find("<path", svg.find("gnuplot_plot_1"));
    return std::ranges::count(svg.substr(curve, svg.find("/>", curve) - curve), 'M');
  };
  EXPECT_EQ(moves(drawing(3)) + 1, moves(drawing(std::nan(""))));
}

// gnuplot warns of axes without extent.
TEST(Plot, AWarningIsNoPartOfTheDrawing) {
  const Plot point{.title = "one", .x_label = "x", .y_label = "y", .series = {{"still", {2, 2}, {3, 3}}}};
  const std::string svg = svg_of(point);
  EXPECT_TRUE(svg.starts_with("<?xml")) << svg.substr(0, 100);
  EXPECT_TRUE(svg.ends_with("</svg>\n\n")) << svg.substr(svg.size() - 20);
}

TEST(Plot, SaysWhereGnuplotRefuses) {
  const Plot empty{.title = "nothing to draw", .x_label = "", .y_label = ""};
  try {
    svg_of(empty);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("gnuplot failed ("), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("plot"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace splatscope::studies
