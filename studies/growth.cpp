#include "studies/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "studies/frame_cost.h"
#include "studies/peak_memory.h"

namespace splatscope::studies {
namespace {

constexpr std::array kSides = {100, 178, 316, 562, 1000};
constexpr int kRunsOfSurfels = 300000;  // small frames run several times
constexpr int kFewestRuns = 2, kMostRuns = 5;

constexpr int kWarmUpSide = 64;     // of a frame before: it touches the code and the threads' buffers
constexpr double kPaperSide = 256;  // surfels; of the plane that the default camera looks at

// The paper's plane in more or fewer surfels, with the camera as much further away: the same picture in more
// or fewer pixels, so that each surfel is as much work. One view of few pixels captures the weights: these
// change no time. All vertices lie in video memory, however large: else large frames would be those of
// another machine, which reads over AGP and takes more cycles a surfel.
GrowthRow row_of(int side, const Machine& machine) {
  const double scale = side / kPaperSide;
  traces::Scene scene = traces::parse_scene(
      fmt::format("[surfels]\ngenerator = \"plane\"\ncolumns = {0}\nrows = {0}\n[frame]\nwidth = {1}\n"
                  "height = {1}\n[splatting]\nvertex_memory = \"video\"\nvideo_megabytes = 4096\n"
                  "[capture]\nviews = 1\nframe_size = 64\n",
                  side, 2 * side),
      "plane");
  scene.camera.eye *= scale;
  scene.camera.target *= scale;
  scene.camera.near *= scale;
  scene.camera.far *= scale;
  const int surfels = side * side;
  const bool is_measured = restart_peak_memory();
  const double before = peak_megabytes();
  const Trace trace = traces::record(scene, machine.numbers).trace;
  const int runs = std::clamp(kRunsOfSurfels / surfels, kFewestRuns, kMostRuns);
  GrowthRow row;
  row.surfels = surfels;
  if (is_measured) row.trace_megabytes = peak_megabytes() - before;
  const auto cost = [&](Fidelity fidelity) {
    FrameCost cost = cost_of(trace, machine, fidelity, runs);
    if (cost.megabytes > 0) cost.megabytes -= before;
    cost.timing.reset();  // it would be in the next one's memory
    return cost;
  };
  row.functional = cost(Fidelity::functional);
  row.sampled = cost(Fidelity::sampled);
  row.cycle = cost(Fidelity::cycle);
  return row;
}

struct Measure {
  std::string_view name;
  double (*value)(const GrowthRow& row);
};
constexpr Measure kMeasures[] = {
    {"functional, s", [](const GrowthRow& row) { return row.functional.seconds; }},
    {"sampled, s", [](const GrowthRow& row) { return row.sampled.seconds; }},
    {"cycle, s", [](const GrowthRow& row) { return row.cycle.seconds; }},
    {"trace, MB", [](const GrowthRow& row) { return row.trace_megabytes; }},
    {"functional, MB", [](const GrowthRow& row) { return row.functional.megabytes; }},
    {"sampled, MB", [](const GrowthRow& row) { return row.sampled.megabytes; }},
    {"cycle, MB", [](const GrowthRow& row) { return row.cycle.megabytes; }}};

Plot::Series series_of(std::span<const GrowthRow> rows, const Measure& measure) {
  Plot::Series series{.name = std::string(measure.name)};
  for (const GrowthRow& row : rows) {
    series.x.push_back(row.surfels);
    series.y.push_back(measure.value(row));
  }
  return series;
}

}  // namespace

double log_log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]), v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

FixedAndLinear fixed_and_linear(const std::vector<double>& x, const std::vector<double>& y) {
  double uu = 0, uv = 0, vv = 0, u_sum = 0, v_sum = 0;  // of fixed u + linear v = 1
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = 1 / y[i], v = x[i] / y[i];
    uu += u * u;
    uv += u * v;
    vv += v * v;
    u_sum += u;
    v_sum += v;
  }
  FixedAndLinear fit;
  fit.fixed = (u_sum * vv - v_sum * uv) / (uu * vv - uv * uv);
  fit.linear = (v_sum - fit.fixed * uv) / vv;
  if (fit.fixed < 0) fit = {0, v_sum / vv};
  if (fit.linear < 0) fit = {u_sum / uu, 0};
  for (std::size_t i = 0; i < x.size(); ++i)
    fit.worst = std::max(fit.worst, std::abs(fit.fixed + fit.linear * x[i] - y[i]) / y[i]);
  return fit;
}

std::vector<GrowthRow> growth_rows(std::span<const int> sides, const Progress& progress) {
  const Machine machine = machine::load(machine::kGeForce4);
  double all = 0, done = 0;
  for (const int side : sides) all += side * side;
  row_of(kWarmUpSide, machine);
  std::vector<GrowthRow> rows;
  for (const int side : sides) {
    rows.push_back(row_of(side, machine));
    done += side * side;
    if (progress) progress(done / all);
  }
  return rows;
}

void add_growth_report(Findings& findings, std::span<const GrowthRow> rows) {
  using enum Report::Align;
  auto results = nlohmann::ordered_json::object();
  std::vector<Report::Column> columns{{"surfels", number}};
  std::vector<std::vector<std::string>> cells(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    cells[i].push_back(fmt::format("{}", rows[i].surfels));
    results["surfels"].push_back(rows[i].surfels);
  }
  std::vector<std::string> slopes{"slope"}, fixed{"fixed"}, linear{"per 1000"}, worst{"off by, %"};
  Plot plot{.title = "Growth of a frame",
            .x_label = "surfels",
            .y_label = "seconds or megabytes",
            .log_x = true,
            .log_y = true};
  for (const Measure& measure : kMeasures) {
    const Plot::Series series = series_of(rows, measure);
    if (!std::ranges::all_of(series.y, [](double value) { return value > 0; })) continue;
    columns.push_back({series.name, number});
    plot.series.push_back(series);
    const double slope = log_log_slope(series.x, series.y);
    for (std::size_t i = 0; i < rows.size(); ++i) cells[i].push_back(fmt::format("{:.3f}", series.y[i]));
    slopes.push_back(fmt::format("{:.2f}", slope));
    const FixedAndLinear fit = fixed_and_linear(series.x, series.y);
    fixed.push_back(fmt::format("{:.3f}", fit.fixed));
    linear.push_back(fmt::format("{:.5f}", 1000 * fit.linear));
    worst.push_back(fmt::format("{:.0f}", 100 * fit.worst));
    results["measures"][series.name] = {{"values", series.y},
                                        {"log_log_slope", slope},
                                        {"fixed", fit.fixed},
                                        {"per_surfel", fit.linear},
                                        {"worst_fraction", fit.worst}};
  }
  cells.insert(cells.end(), {slopes, fixed, linear, worst});
  findings.report().heading("Growth with the number of surfels");
  findings.table(
      "Planes with four pixels a surfel, times and memory the least of some runs. Below them the slope in "
      "log-log, "
      "and a fixed part and that of a thousand surfels, which together are off by the least.",
      columns, cells);
  findings.plot("growth", plot);
  findings.result("growth", std::move(results));
}

void study_growth(Findings& findings, const Progress& progress) {
  add_growth_report(findings, growth_rows(kSides, progress));
}

}  // namespace splatscope::studies
