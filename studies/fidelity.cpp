#include "studies/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/peak_memory.h"
#include "traces/weight_capture.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kMachines[] = {"geforce4-ti4400", "radeon-8500"};
constexpr Fidelity kAll[] = {Fidelity::functional, Fidelity::throughput, Fidelity::sampled, Fidelity::cycle,
                             Fidelity::referee};
constexpr std::string_view kTable1[] = {"checkerboard-no-ewa", "checkerboard-ewa-per-pixel",
                                        "checkerboard-ewa-per-surfel"};
constexpr std::string_view kTable2[] = {"salamander", "chameleon", "wasp", "fiesta"};
constexpr int kTable2Surfels = 30000;
constexpr double kLeastError = 1e-6;  // that the plot shows

struct Timed {
  std::optional<sim::Result> timing;
  double seconds = 0;  // least
  double megabytes = 0;
};

Timed time_run(const Trace& trace, const Machine& machine, Fidelity fidelity, int repetitions) {
  Timed timed;
  for (int i = 0; i < (fidelity == Fidelity::referee ? 1 : repetitions); ++i) {
    const bool is_measured = restart_peak_memory();
    FrameRun run = run_frame(trace, machine, fidelity);
    timed.seconds = i == 0 ? run.host_seconds : std::min(timed.seconds, run.host_seconds);
    timed.timing = std::move(run.timing);
    if (is_measured) timed.megabytes = static_cast<double>(peak_memory()) / 1e6;
  }
  return timed;
}

FidelityRow row_of(const std::string& scene, std::string_view machine, Fidelity fidelity,
                   const Timed& timed) {
  FidelityRow row;
  row.scene = scene;
  row.machine = machine;
  row.fidelity = fidelity;
  row.host_seconds = timed.seconds;
  row.peak_megabytes = timed.megabytes;
  if (!timed.timing) return row;
  row.cycles = timed.timing->cycles;
  row.cycles_plus_minus = timed.timing->cycles_plus_minus;
  for (const sim::UnitBooks& books : timed.timing->units)
    row.units.push_back({books.name, static_cast<double>(books.busy) / static_cast<double>(row.cycles)});
  return row;
}

// Utilisations become errors.
void compare_with(const FidelityRow& referee, FidelityRow& row) {
  if (row.cycles == 0) return;
  row.error = static_cast<double>(row.cycles) / static_cast<double>(referee.cycles) - 1;
  for (std::size_t i = 0; i < row.units.size(); ++i) row.units[i].error -= referee.units[i].error;
}

double worst_unit(const FidelityRow& row) {
  double worst = 0;
  for (const auto& unit : row.units) worst = std::max(worst, std::abs(unit.error));
  return worst;
}

// What one fidelity does over all frames.
struct Summary {
  Fidelity fidelity;
  double seconds = 0, cycles = 0, megabytes = 0;
  double worst_error = 0, mean_error = 0, worst_unit = 0;
  int frames = 0, covered = 0;  // by the interval
};

std::vector<Summary> summaries_of(const std::vector<FidelityRow>& rows) {
  std::vector<Summary> summaries;
  for (const Fidelity fidelity : kAll) {
    Summary s;
    s.fidelity = fidelity;
    for (const FidelityRow& row : rows) {
      if (row.fidelity != fidelity) continue;
      const auto cycles = static_cast<double>(row.cycles);
      ++s.frames;
      s.seconds += row.host_seconds;
      s.cycles += cycles;
      s.megabytes = std::max(s.megabytes, row.peak_megabytes);
      s.worst_error = std::max(s.worst_error, std::abs(row.error));
      s.mean_error += std::abs(row.error);
      s.worst_unit = std::max(s.worst_unit, worst_unit(row));
      s.covered += std::abs(cycles - cycles / (1 + row.error)) <= row.cycles_plus_minus;
    }
    s.mean_error /= std::max(s.frames, 1);
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

std::string text_of(const std::vector<Summary>& summaries) {
  std::string text = fmt::format("{:<11} {:>11} {:>9} {:>12} {:>11} {:>12} {:>8}\n", "fidelity", "s a frame",
                                 "Mcycles/s", "worst error", "mean error", "utilisation", "peak MB");
  for (const Summary& s : summaries) {
    const auto cells = cells_of(s);
    text += fmt::format("{:<11} {:>11} {:>9} {:>12} {:>11} {:>12} {:>8}\n", cells[0], cells[1], cells[2],
                        cells[3], cells[4], cells[5], cells[6]);
    if (s.fidelity == Fidelity::sampled)
      text += fmt::format("            its interval covers {} of {} frames\n", s.covered, s.frames);
  }
  return text;
}

void add_frames(Report& report, const std::vector<FidelityRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const FidelityRow& row : rows) {
    const bool timed = row.cycles != 0;
    const auto cycles = static_cast<double>(row.cycles);
    std::string shown = timed ? fmt::format("{}", row.cycles) : "";
    if (row.cycles_plus_minus > 0) shown += fmt::format(" ± {:.2f} %", 100 * row.cycles_plus_minus / cycles);
    cells.push_back({row.scene, row.machine, std::string(name(row.fidelity)),
                     fmt::format("{:.3f}", row.host_seconds),
                     timed ? fmt::format("{:.1f}", cycles / row.host_seconds / 1e6) : "", shown,
                     timed ? fmt::format("{:+.3f} %", 100 * row.error) : "",
                     timed ? fmt::format("{:.1f}", 100 * worst_unit(row)) : "",
                     fmt::format("{:.0f}", row.peak_megabytes)});
  }
  report.table("Every frame. Utilisation: the worst unit's, in percentage points of the referee's.",
               {{"scene"},
                {"machine"},
                {"fidelity"},
                {"host s", number},
                {"Mcycles/s", number},
                {"cycles", number},
                {"error", number},
                {"utilisation", number},
                {"peak MB", number}},
               cells);
}

// The worst error of each unit over all frames, by fidelity.
void add_units(Report& report, const std::vector<FidelityRow>& rows) {
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
    for (const Fidelity fidelity : std::span(kAll).subspan(1, 3)) {
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

void add_to(Findings& findings, const std::vector<FidelityRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const Summary& summary : summaries_of(rows)) cells.push_back(cells_of(summary));
  Report& report = findings.report();
  report.heading("Speed against accuracy");
  report.paragraph(fmt::format(
      "All frames of Table 1, and the stand-ins of Table 2 with {} surfels each, at 512 x 512 on both "
      "machines. Host seconds hold function and timing, and are the least of three runs (the referee's: of "
      "one). Errors are against the referee. Memory is that of the whole process, the trace included.",
      kTable2Surfels));
  report.table("Over all frames. Utilisation: the worst of any unit, in percentage points.",
               {{"fidelity"},
                {"s a frame", number},
                {"Mcycles/s", number},
                {"worst error", number},
                {"mean error", number},
                {"utilisation", number},
                {"peak MB", number}},
               cells);
  Plot plot{.title = "Error against speed (no error: drawn at 0.0001 %)",
            .x_label = "simulated cycles a host second, millions",
            .y_label = "error of the cycles, %",
            .log_x = true,
            .log_y = true};
  for (const Fidelity fidelity : std::span(kAll).subspan(1)) {
    Plot::Series series{.name = std::string(name(fidelity)), .x = {}, .y = {}, .joined = false};
    for (const FidelityRow& row : rows) {
      if (row.fidelity != fidelity) continue;
      series.x.push_back(static_cast<double>(row.cycles) / row.host_seconds / 1e6);
      series.y.push_back(100 * std::max(std::abs(row.error), kLeastError));
    }
    plot.series.push_back(std::move(series));
  }
  findings.plot("fidelity", plot);
  add_units(report, rows);
  add_frames(report, rows);
}

nlohmann::ordered_json json_of(const std::vector<FidelityRow>& rows) {
  auto out = nlohmann::ordered_json::array();
  for (const FidelityRow& row : rows) {
    nlohmann::ordered_json entry = {{"scene", row.scene},
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
    out.push_back(std::move(entry));
  }
  return out;
}

std::vector<traces::Scene> scenes() {
  std::vector<traces::Scene> scenes;
  for (const std::string_view ready : kTable1) scenes.push_back(traces::load_scene(ready));
  for (const std::string_view model : kTable2) {
    scenes.push_back(traces::parse_scene(
        fmt::format("[surfels]\ngenerator = \"{}\"\ncount = {}\n[frame]\nwidth = 512\nheight = 512\n", model,
                    kTable2Surfels),
        std::string(model)));
  }
  return scenes;
}

}  // namespace

std::vector<FidelityRow> fidelity_rows(const traces::Scene& scene, int repetitions,
                                       const Progress& progress) {
  std::vector<FidelityRow> rows;
  for (const std::string_view machine_name : kMachines) {
    const Machine machine = machine::load(machine_name);
    const Trace trace = traces::record(scene, machine.numbers).trace;
    const std::size_t first = rows.size();
    for (const Fidelity fidelity : kAll) {
      rows.push_back(
          row_of(scene.name, machine_name, fidelity, time_run(trace, machine, fidelity, repetitions)));
      if (progress) progress(static_cast<double>(rows.size()) / (std::size(kMachines) * std::size(kAll)));
    }
    const FidelityRow referee = rows.back();
    for (std::size_t i = first; i < rows.size(); ++i) compare_with(referee, rows[i]);
  }
  return rows;
}

void study_fidelity(Findings& findings, const Progress& progress) {
  std::vector<FidelityRow> rows;
  const std::vector<traces::Scene> all = scenes();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double size = static_cast<double>(all.size());
    const auto of_scene = fidelity_rows(
        all[i], 3, part(progress, static_cast<double>(i) / size, static_cast<double>(i + 1) / size));
    rows.insert(rows.end(), of_scene.begin(), of_scene.end());
  }
  findings.say(text_of(summaries_of(rows)));
  add_to(findings, rows);
  findings.result("fidelity", json_of(rows));
}

}  // namespace splatscope::studies
