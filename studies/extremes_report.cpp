#include <fmt/format.h>

#include <cmath>

#include "studies/extremes.h"

namespace splatscope::studies {
namespace {

using Json = nlohmann::ordered_json;

std::string first_value(double value) {
  return std::isnan(value) ? "never" : fmt::format("{:.1e}", value);
}

// What comes out of the paper's program where one input is not finite, or a denormal.
std::string text_of_special_inputs() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::pair<std::string_view, double> values[] = {
      {"INF", kInfinity}, {"NaN", std::numeric_limits<double>::quiet_NaN()}, {"denormal", 1e-40}};
  const std::pair<std::string_view, double& (*)(kernels::Surfel&)> inputs[] = {
      {"position", [](kernels::Surfel& s) -> double& { return s.position.x; }},
      {"tangent s", [](kernels::Surfel& s) -> double& { return s.tangent_s.x; }},
      {"sigma", [](kernels::Surfel& s) -> double& { return s.sigma; }},
      {"weight", [](kernels::Surfel& s) -> double& { return s.weight; }},
      {"colour", [](kernels::Surfel& s) -> double& { return s.color.x; }}};
  std::string text = fmt::format("{:<10} {:<9} {:<28} {:<28}\n", "input", "value", "ieee", "nv20");
  for (const auto& [input, place] : inputs) {
    for (const auto& [name, value] : values) {
      kernels::Surfel surfel{{0.1, 0.2, 4}, {0.02, 0, 0}, {0, 0.02, 0}, 1, 1, {1, 1, 1}};
      place(surfel) = value;
      text += fmt::format("{:<10} {:<9}", input, name);
      for (const Arithmetic arithmetic : {Arithmetic::ieee, Arithmetic::nv20}) {
        const auto quad = kernels::run_quads(kernels::ewa_program("paper"), arithmetic, kernels::plain_view(),
                                             0.0, std::vector<kernels::Surfel>{surfel})[0];
        bool position = true, color = true;
        for (const auto& corner : quad) {
          for (int i = 0; i < 4; ++i) {
            position &= std::isfinite(corner.position[i]);
            color &= std::isfinite(corner.diffuse[i]);
          }
        }
        text += fmt::format(" {:<28}", !position ? "position not finite: dropped"
                                       : !color  ? "colour not finite: clamped"
                                                 : "finite");
      }
      text += "\n";
    }
  }
  return text;
}

std::string text_of(std::span<const ExtremeRow> rows) {
  std::string text, sweep;
  for (const ExtremeRow& row : rows) {
    if (row.sweep != sweep) {
      sweep = row.sweep;
      text +=
          fmt::format("{}{}: {:.0e} to {:.0e}\n  {:<24} {:>9} {:>9} {:>9}\n", text.empty() ? "" : "\n", sweep,
                      row.values.front(), row.values.back(), "error first over", "1 %", "10 %", "100 %");
    }
    text += fmt::format("  {:<24} {:>9} {:>9} {:>9}\n", row.splatter, first_value(row.over_1),
                        first_value(row.over_10), first_value(row.over_all));
  }
  return text;
}

}  // namespace

std::string line_of(const GuardRow& row, std::string_view arithmetic) {
  const auto counts = [](const GuardRow::Counts& c) {
    return fmt::format("{:>7} {:>6} {:>6}", c.not_finite, c.off, c.too_wide);
  };
  return fmt::format("{:<36} {:<7} {:<5} {:>5}  {}  {}  {}", row.guard.name, row.guard.program, arithmetic,
                     row.slots, counts(row.without), counts(row.with), row.guard.repairs);
}

void study_extremes(Findings& findings, const Progress& progress) {
  constexpr int kOfAKind = 5000;
  findings.report().heading("Where the formulas break");
  std::vector<ExtremeRow> rows;
  Json list = Json::array();
  const auto sweeps = extreme_sweeps();
  for (const ExtremeSweep& sweep : sweeps) {
    Plot plot{.title = sweep.name,
              .x_label = sweep.name,
              .y_label = "relative error",
              .log_x = true,
              .log_y = true};
    for (const Splatter& splatter : splatters()) {
      const ExtremeRow row = sweep_row(sweep, splatter, kSurfelsAValue, kExtremesSeed);
      plot.series.push_back({.name = row.splatter, .x = row.values, .y = row.errors});
      list.push_back({{"sweep", row.sweep},
                      {"splatter", row.splatter},
                      {"values", row.values},
                      {"errors", row.errors},
                      {"over_1_percent", row.over_1},
                      {"over_10_percent", row.over_10},
                      {"over_all", row.over_all}});
      rows.push_back(row);
    }
    findings.plot(fmt::format("extremes-{}", &sweep - sweeps.data()), plot);
    tell(part(progress, 0, 0.7), static_cast<std::size_t>(&sweep - sweeps.data()) + 1, sweeps.size());
  }
  findings.text(text_of(rows));
  findings.text(
      fmt::format("\n{:<36} {:<7} {:<5} {:>5}  {:<21}  {:<21}\n{:>57} {:>7} {:>6} {:>6}  {:>7} {:>6} {:>6}\n",
                  "guard", "program", "arith", "slots", "without it", "with it", "", "not fin", "10 %",
                  "wide", "not fin", "10 %", "wide"));
  Json guard_list = Json::array();
  for (const Guard& guard : guards()) {
    for (const auto& [arithmetic, name] :
         {std::pair{Arithmetic::ieee, "ieee"}, std::pair{Arithmetic::nv20, "nv20"}}) {
      const GuardRow row = guard_row(guard, arithmetic, kOfAKind, kExtremesSeed);
      findings.text(line_of(row, name) + "\n");
      const auto counts = [](const GuardRow::Counts& c) {
        return Json{{"not_finite", c.not_finite}, {"off_10_percent", c.off}, {"too_wide", c.too_wide}};
      };
      guard_list.push_back({{"guard", guard.name},
                            {"program", guard.program},
                            {"arithmetic", name},
                            {"slots", row.slots},
                            {"without", counts(row.without)},
                            {"with", counts(row.with)}});
    }
  }
  findings.text("\n" + text_of_special_inputs());
  findings.result("extremes", {{"sweeps", std::move(list)}, {"guards", std::move(guard_list)}});
}

}  // namespace splatscope::studies
