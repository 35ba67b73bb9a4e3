#pragma once

#include <glm/mat2x2.hpp>
#include <string>
#include <vector>

#include "studies/report.h"

namespace splatscope::studies {

// Curves over one pair of axes, drawn by gnuplot.
struct Plot {
  std::string title;
  std::string x_label, y_label;  // with their units
  bool log_x = false, log_y = false;
  bool same_scale = false;  // a unit of x is as long as one of y
  struct Series {
    std::string name;
    std::vector<double> x = {}, y = {};  // of one length; values that are not finite are left out
    bool joined = true;                  // by a line; else points alone
    bool with_last = false;              // one colour with the series before it, and large points
  };
  std::vector<Series> series = {};
};

// The image of the unit circle: one standard deviation of the Gaussian whose axes these are.
Plot::Series ellipse(const std::string& name, const glm::dmat2& axes);

// The plot as the text of an SVG file. Throws std::runtime_error where gnuplot fails or is missing.
std::string svg_of(const Plot& plot);

// The plot in a page, or why there is none: where gnuplot fails, what was measured is not to be lost. The
// text of the SVG, or "".
std::string add_plot(Report& report, const Plot& plot);

}  // namespace splatscope::studies
