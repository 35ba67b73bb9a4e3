#include "studies/plot.h"

#include <gtest/gtest.h>

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
  EXPECT_NE(std::string::npos, svg.find("</svg>"));
  for (const char* text : {"first", "second", "x, mm", "error", "it's", "`date`"})
    EXPECT_NE(std::string::npos, svg.find(text)) << text;
}

TEST(Plot, SaysWhereGnuplotRefuses) {
  const Plot empty{.title = "nothing to draw", .x_label = "", .y_label = ""};
  EXPECT_THROW(svg_of(empty), std::runtime_error);
}

}  // namespace
}  // namespace splatscope::studies
