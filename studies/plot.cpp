#include "studies/plot.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "model/shell_word.h"
#include "model/stop.h"
#include "model/temporary_folder.h"

namespace splatscope::studies {
namespace {

// In gnuplot's single quotes, where a quote is written twice and nothing else means anything.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' ? ' ' : c;
  }
  return result + "'";
}

std::string script_of(const Plot& plot) {
  std::string script =
      "set terminal svg size 720,440 font 'sans-serif,13' noenhanced background rgb 'white'\n"
      "set key below\nset format '%g'\nset grid lc rgb '#d9dde1'\nset offsets graph 0.02, graph 0.02, "
      "graph 0.05, graph 0.05\n";
  // A line below the x label, which else touches the key.
  script += fmt::format("set title {}\nset xlabel {}.\"\\n\"\nset ylabel {}\n", quoted(plot.title),
                        quoted(plot.x_label), quoted(plot.y_label));
  if (plot.same_scale) script += "set size ratio -1\n";
  if (plot.log_x) script += "set logscale x\n";
  if (plot.log_y) script += "set logscale y\n";
  std::string curves;
  int color = 0;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Plot::Series& series = plot.series[i];
    script += fmt::format("$s{} << EOD\n", i);
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      const bool is_there = std::isfinite(series.x[k]) && std::isfinite(series.y[k]);
      // An empty line ends a curve, and another begins behind it.
      script += is_there ? fmt::format("{:.9g} {:.9g}\n", series.x[k], series.y[k]) : "\n";
    }
    script += "EOD\n";
    if (!series.with_last) ++color;
    curves += fmt::format("{}$s{} with {} pt 7 ps {} lt {} title {}", i == 0 ? "plot " : ", ", i,
                          series.joined ? "linespoints" : "points", series.with_last ? 1.5 : 0.5, color,
                          quoted(series.name));
  }
  return script + (curves.empty() ? "plot" : curves) + "\n";
}

}  // namespace

Plot::Series ellipse(const std::string& name, const glm::dmat2& axes) {
  Plot::Series series{name, {}, {}};
  for (int degree = 0; degree <= 360; degree += 5) {
    const double angle = degree * std::numbers::pi / 180;
    const glm::dvec2 point = axes * glm::dvec2(std::cos(angle), std::sin(angle));
    series.x.push_back(point.x);
    series.y.push_back(point.y);
  }
  return series;
}

// What gnuplot says besides, such as warnings of an axis without extent, is no part of the drawing; the
// user's own settings (-d) are none of it either.
std::string svg_of(const Plot& plot) {
  const TemporaryFolder folder;  // others, and who else has the machine, have theirs
  const std::filesystem::path script = folder / "script", errors = folder / "errors";
  if (!(std::ofstream(script) << script_of(plot)).flush())
    throw std::runtime_error(script.string() + ": writing failed (is the disk full?)");
  std::FILE* pipe = ::popen(
      fmt::format("gnuplot -d {} 2>{}", shell_word(script.string()), shell_word(errors.string())).c_str(),
      "r");
  if (pipe == nullptr) throw std::runtime_error("gnuplot cannot be started");
  std::string text;
  char part[4096];
  for (std::size_t n = 0; (n = std::fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, n);
  const int status = ::pclose(pipe);
  stop_if_asked();
  if (status != 0) {
    std::ifstream said(errors);
    const std::string why{std::istreambuf_iterator<char>(said), {}};
    throw std::runtime_error(fmt::format("gnuplot failed ({}), expected the package gnuplot-nox", why));
  }
  return text;
}

std::string add_plot(Report& report, const Plot& plot) {
  try {
    std::string svg = svg_of(plot);
    report.drawing(plot.title, svg);
    return svg;
  } catch (const std::runtime_error& error) {  // no reason to lose what may have taken hours
    report.paragraph(fmt::format("No curves of \"{}\": {}.", plot.title, error.what()));
    return "";
  }
}

}  // namespace splatscope::studies
