#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/fidelity.h"

// What the study of fidelities says of its rows.
namespace splatscope::studies {
namespace {

constexpr double kLeastError = 1e-6;  // that the plot shows

double worst_unit(const FidelityRow& row) {
  double worst = 0;
  for (const auto& unit : row.units) worst = std::max(worst, std::abs(unit.error));
  return worst;
}

// The errors of the cycles of a frame: of `sampled`, of every seed.
std::vector<double> errors_of(const FidelityRow& row) {
  if (row.seeds.empty()) return {std::abs(row.error)};
  std::vector<double> errors;
  for (const FidelityRow::Seed& seed : row.seeds) errors.push_back(std::abs(seed.error));
  return errors;
}

// Half the interval of `sampled`, relative: on average over the seeds of a frame.
double half_interval(const FidelityRow& row) {
  double sum = 0;
  for (const FidelityRow::Seed& seed : row.seeds) sum += seed.plus_minus / seed.cycles;
  return sum / static_cast<double>(std::max<std::size_t>(row.seeds.size(), 1));
}

std::ptrdiff_t covered(const FidelityRow& row) {
  return std::ranges::count_if(row.seeds, &FidelityRow::Seed::covers);
}

// What one fidelity does over all frames of a group.
struct Summary {
  Fidelity fidelity;
  double seconds = 0, cycles = 0, megabytes = 0;
  double worst_error = 0, mean_error = 0, worst_unit = 0;
  int frames = 0;
  // Of `sampled`, over all seeds.
  std::size_t runs = 0, covered = 0;
  double widest = 0, mean_width = 0;  // half the interval, relative

  void add(const FidelityRow& row) {
    ++frames;
    seconds += row.host_seconds;
    cycles += static_cast<double>(row.cycles);
    megabytes = std::max(megabytes, row.peak_megabytes);
    const std::vector<double> errors = errors_of(row);
    for (const double error : errors) {
      worst_error = std::max(worst_error, error);
      mean_error += error / static_cast<double>(errors.size());
    }
    worst_unit = std::max(worst_unit, studies::worst_unit(row));
    runs += row.seeds.size();
    covered += static_cast<std::size_t>(studies::covered(row));
    for (const FidelityRow::Seed& seed : row.seeds) widest = std::max(widest, seed.plus_minus / seed.cycles);
    mean_width += half_interval(row);
  }
};

std::vector<Summary> summaries_of(std::span<const FidelityRow> rows) {
  std::vector<Summary> summaries;
  for (const Fidelity fidelity : kFidelityLadder) {
    Summary s;
    s.fidelity = fidelity;
    for (const FidelityRow& row : rows) {
      if (row.fidelity == fidelity) s.add(row);
    }
    if (s.frames == 0) continue;
    s.mean_error /= s.frames;
    s.mean_width /= s.frames;
    summaries.push_back(s);
  }
  return summaries;
}

std::vector<std::string> cells_of(const Summary& s) {
  if (s.cycles == 0)
    return {std::string(name(s.fidelity)),     fmt::format("{:.3f}", s.seconds / s.frames), "", "", "", "",
            fmt::format("{:.0f}", s.megabytes)};
  return {std::string(name(s.fidelity)),
          fmt::format("{:.3f}", s.seconds / s.frames),
          fmt::format("{:.1f}", s.cycles / s.seconds / 1e6),
          fmt::format("{:.2f} %", 100 * s.worst_error),
          fmt::format("{:.2f} %", 100 * s.mean_error),
          fmt::format("{:.1f}", 100 * s.worst_unit),
          fmt::format("{:.0f}", s.megabytes)};
}

void add_frames(Report& report, std::span<const FidelityRow> rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const FidelityRow& row : rows) {
    const bool timed = row.cycles != 0;
    const auto cycles = static_cast<double>(row.cycles);
    std::string shown = timed ? fmt::format("{}", row.cycles) : "";
    if (row.cycles_plus_minus > 0) shown += fmt::format(" ± {:.2f} %", 100 * row.cycles_plus_minus / cycles);
    const double worst = std::ranges::max(errors_of(row));
    cells.push_back({row.scene, fmt::format("{}", row.resolution), row.machine,
                     std::string(name(row.fidelity)), fmt::format("{:.3f}", row.host_seconds),
                     timed ? fmt::format("{:.1f}", cycles / row.host_seconds / 1e6) : "", shown,
                     timed ? fmt::format("{:+.3f} %", 100 * row.error) : "",
                     row.seeds.empty()
                         ? ""
                         : fmt::format("{:.3f} %, {} of {}", 100 * worst, covered(row), row.seeds.size()),
                     timed ? fmt::format("{:.1f}", 100 * worst_unit(row)) : "",
                     fmt::format("{:.0f}", row.peak_megabytes)});
  }
  report.table(
      fmt::format(
          "Every frame. Seeds: the worst error of sampled by seeds 0 to {}, and how often its "
          "interval covers the referee's cycles. Utilisation: the worst unit's, in percentage points "
          "of the referee's. Of several frames of one trace, seconds are their average (and so is what "
          "the rate divides by), and utilisation is of all of them.",
          kSampleSeeds - 1),
      {{"scene"},
       {"size", number},
       {"machine"},
       {"fidelity"},
       {"host s", number},
       {"Mcycles/s", number},
       {"cycles", number},
       {"error", number},
       {"seeds", number},
       {"utilisation", number},
       {"peak MB", number}},
      cells);
}

// The worst error of each unit over all frames, by fidelity.
void add_units(Report& report, std::span<const FidelityRow> rows) {
  using enum Report::Align;
  std::vector<std::string> units;
  for (const FidelityRow& row : rows) {
    for (const auto& unit : row.units) {
      if (std::ranges::find(units, unit.unit) == units.end()) units.push_back(unit.unit);
    }
  }
  std::vector<std::vector<std::string>> cells;
  for (const std::string& name : units) {
    cells.push_back({name});
    for (const Fidelity fidelity : std::span(kFidelityLadder).subspan(1, 3)) {
      double worst = 0;
      for (const FidelityRow& row : rows) {
        if (row.fidelity != fidelity) continue;
        for (const auto& unit : row.units) {
          if (unit.unit == name) worst = std::max(worst, std::abs(unit.error));
        }
      }
      cells.back().push_back(fmt::format("{:.2f}", 100 * worst));
    }
  }
  report.table("Utilisation of each unit: the worst error over all frames, in percentage points.",
               {{"unit"}, {"throughput", number}, {"sampled", number}, {"cycle", number}}, cells);
}

void add_summary(Report& report, const std::string& caption, const std::vector<Summary>& summaries) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const Summary& summary : summaries) cells.push_back(cells_of(summary));
  report.table(caption,
               {{"fidelity"},
                {"s a frame", number},
                {"Mcycles/s", number},
                {"worst error", number},
                {"mean error", number},
                {"utilisation", number},
                {"peak MB", number}},
               cells);
}

void add_plot(Findings& findings, std::span<const FidelityRow> rows) {
  Plot plot{.title = "Error against speed (no error: drawn at 0.0001 %)",
            .x_label = "simulated cycles a host second, millions",
            .y_label = "error of the cycles, %",
            .log_x = true,
            .log_y = true};
  for (const Fidelity fidelity : std::span(kFidelityLadder).subspan(1)) {
    Plot::Series series{.name = std::string(name(fidelity)), .joined = false};
    for (const FidelityRow& row : rows) {
      if (row.fidelity != fidelity) continue;
      series.x.push_back(static_cast<double>(row.cycles) / row.host_seconds / 1e6);
      series.y.push_back(100 * std::max(std::ranges::max(errors_of(row)), kLeastError));
    }
    plot.series.push_back(std::move(series));
  }
  findings.plot("fidelity", plot);
}

nlohmann::ordered_json json_of(std::span<const FidelityRow> rows) {
  auto out = nlohmann::ordered_json::array();
  for (const FidelityRow& row : rows) {
    nlohmann::ordered_json entry = {{"scene", row.scene},
                                    {"resolution", row.resolution},
                                    {"machine", row.machine},
                                    {"fidelity", name(row.fidelity)},
                                    {"host_seconds", row.host_seconds},
                                    {"peak_megabytes", row.peak_megabytes}};
    if (row.cycles != 0) {
      entry["cycles"] = row.cycles;
      entry["cycles_plus_minus"] = row.cycles_plus_minus;
      entry["cycles_per_host_second"] = static_cast<double>(row.cycles) / row.host_seconds;
      entry["error"] = row.error;
      for (const auto& unit : row.units) entry["utilisation_errors"][unit.unit] = unit.error;
    }
    for (const FidelityRow::Seed& seed : row.seeds) {
      entry["seeds"].push_back(
          {{"cycles", seed.cycles}, {"cycles_plus_minus", seed.plus_minus}, {"error", seed.error}});
    }
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace

bool FidelityRow::Seed::covers() const {
  return std::abs(cycles - cycles / (1 + error)) <= plus_minus;
}

std::string fidelity_text(const FidelityGroup& group) {
  const std::vector<Summary> summaries = summaries_of(group.rows);
  std::string text = fmt::format("{}, {} frames against the referee\n", group.name, summaries[0].frames);
  text += fmt::format("{:<11} {:>11} {:>9} {:>12} {:>11} {:>12} {:>8}\n", "fidelity", "s a frame",
                      "Mcycles/s", "worst error", "mean error", "utilisation", "peak MB");
  for (const Summary& s : summaries) {
    const auto cells = cells_of(s);
    text += fmt::format("{:<11} {:>11} {:>9} {:>12} {:>11} {:>12} {:>8}\n", cells[0], cells[1], cells[2],
                        cells[3], cells[4], cells[5], cells[6]);
    if (s.fidelity == Fidelity::sampled)
      text += fmt::format(
          "            seeds 0 to {}: the interval, +- {:.2f} % on average and {:.2f} % at most, "
          "covers {} of {}\n",
          kSampleSeeds - 1, 100 * s.mean_width, 100 * s.widest, s.covered, s.runs);
  }
  return text;
}

void add_fidelity_report(Findings& findings, std::span<const FidelityGroup> groups) {
  std::vector<FidelityRow> rows;
  for (const FidelityGroup& group : groups) rows.insert(rows.end(), group.rows.begin(), group.rows.end());
  Report& report = findings.report();
  report.heading("Speed against accuracy");
  report.paragraph(fmt::format(
      "All frames of Table 1, of Table 2 (its stand-ins with the published number of points, at both "
      "resolutions), of the figures that draw other scenes and of progressive rendering, on both machines. "
      "Host seconds hold function and timing, and are the least of {} runs "
      "(the referee's: of one). Errors are against the referee; those of sampled are of all seeds from 0 to "
      "{}, of 0 alone where all of a frame is simulated. Memory is that of the whole process, the "
      "trace included.",
      kFidelityRepetitions, kSampleSeeds - 1));
  for (const FidelityGroup& group : groups)
    add_summary(report,
                fmt::format("{}, over all frames. Utilisation: the worst of any unit, in percentage points.",
                            group.name),
                summaries_of(group.rows));
  add_plot(findings, rows);
  add_units(report, rows);
  add_frames(report, rows);
  findings.result("fidelity", json_of(rows));
}

}  // namespace splatscope::studies
