#include "studies/sweep_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "studies/run_results.h"
#include "traces/words.h"

namespace splatscope::studies {
namespace {

constexpr std::size_t kMostCurves = 8;

// "vertex.units = 2, memory.channels = 4" of the first `count` parameters.
std::string settings_text(const SweepPoint& point, std::size_t count) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i)
    texts.push_back(fmt::format("{} = {}", point.settings[i].first, point.settings[i].second));
  return fmt::format("{}", fmt::join(texts, ", "));
}

// What is not as the machine and the input have it, at all points.
std::string changes_text(const Sweep& sweep, const Machine& machine) {
  const nlohmann::ordered_json settings = settings_json(machine);
  std::string text;
  for (const auto& [key, value] : settings.items())
    text += fmt::format("{} {} = {}", text.empty() ? " At all points" : ",", key, value.get<std::string>());
  if (!text.empty()) text += ".";
  for (const std::string& program : sweep.replaced) text += fmt::format(" Changed: {}.", program);
  return text;
}

}  // namespace

std::string csv_of(const Sweep& sweep) {
  std::string text;
  for (const auto& [key, value] : sweep.points.front().settings) text += key + ",";
  text += "frame,cycles,cycles_plus_minus,milliseconds,frames_per_second,bottleneck,bottleneck_busy_share\n";
  for (const SweepPoint& point : sweep.points) {
    std::string settings;
    for (const auto& [key, value] : point.settings) settings += value + ",";
    const auto& frames = point.results["frames"];
    const std::string busiest =  // of all frames together
        frames.size() == 1 ? fmt::format("{},{}", point.rate.bottleneck, point.rate.share) : ",";
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::string plus_minus = frames[i].contains("cycles_plus_minus")
                                         ? fmt::format("{}", frames[i]["cycles_plus_minus"].get<double>())
                                         : "";
      text += fmt::format("{}{},{},{},{},{},{}\n", settings, i, frames[i]["cycles"].get<std::uint64_t>(),
                          plus_minus, frames[i]["milliseconds"].get<double>(),
                          frames[i]["frames_per_second"].get<double>(), busiest);
    }
  }
  return text;
}

std::optional<Plot> plot_of(const Sweep& sweep) {
  const std::size_t others = sweep.points.front().settings.size() - 1;
  Plot plot{.title = "Frames a second",
            .x_label = sweep.points.front().settings.back().first,
            .y_label = "frames a second"};
  for (const SweepPoint& point : sweep.points) {
    const std::string name = settings_text(point, others);
    if (plot.series.empty() || plot.series.back().name != name) {
      if (plot.series.size() == kMostCurves) return std::nullopt;
      plot.series.push_back({.name = name});
    }
    const std::optional<double> x = traces::number_of<double>(point.settings.back().second);
    if (!x) return std::nullopt;
    Plot::Series& curve = plot.series.back();
    const auto at = std::ranges::upper_bound(curve.x, *x) - curve.x.begin();
    curve.x.insert(curve.x.begin() + at, *x);
    curve.y.insert(curve.y.begin() + at, point.rate.fps);
  }
  return plot;
}

Report report_of(const Sweep& sweep, const Machine& machine, Fidelity fidelity) {
  using enum Report::Align;
  Report report("splatscope: sweep", fmt::format("{} on machines like {}, fidelity {}.{}", sweep.input.name,
                                                 machine.name, name(fidelity), changes_text(sweep, machine)));
  if (const auto plot = plot_of(sweep)) {
    add_plot(report, *plot);
  } else {
    report.paragraph(fmt::format(
        "No curves: they are drawn over numbers of the parameter that was named last, and no more than {}.",
        kMostCurves));
  }
  std::vector<Report::Column> columns;
  for (const auto& [key, value] : sweep.points.front().settings) columns.push_back({key, number});
  columns.insert(columns.end(), {{"cycles", number}, {"frames a second", number}, {"bottleneck"}});
  std::vector<std::vector<std::string>> rows;
  for (const SweepPoint& point : sweep.points) {
    std::vector<std::string>& row = rows.emplace_back();
    for (const auto& [key, value] : point.settings) row.push_back(value);
    row.push_back(
        fmt::format("{}{}", point.cycles,
                    point.cycles_plus_minus > 0 ? fmt::format(" ± {:.0f}", point.cycles_plus_minus) : ""));
    row.push_back(fmt::format("{:.2f}", point.rate.fps));
    row.push_back(text_of_bottleneck(point.rate));
  }
  report.table("All machines, the frames of each together.", columns, rows);
  return report;
}

}  // namespace splatscope::studies
