#include "studies/reproduction/table2.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "traces/framing.h"
#include "traces/median.h"

namespace splatscope::studies {
namespace {

constexpr Table2Model kModels[] = {
    {"salamander", 103389, {{256, 18.9, 30.0}, {512, 16.9, 24.9}}},
    {"chameleon", 101685, {{256, 17.0, 23.2}, {512, 14.0, 19.0}}},
    {"wasp", 273325, {{256, 6.1, 8.0}, {512, 5.1, 6.1}}},
    {"fiesta", 352467, {{256, 5.5, 7.0}, {512, 3.8, 5.3}}},
};
constexpr std::string_view kStandIn = "our own model of that name, with as many points";

Table2Row row_of(const Trace& trace, const Machine& machine, Fidelity fidelity, const Progress& progress) {
  const FrameRun run = run_frame(trace, machine, fidelity, progress);
  Table2Row row;
  row.machine = machine.name;
  row.simulated = rate_of(*run.timing);
  return row;
}

nlohmann::ordered_json json_of(const std::vector<Table2Row>& table) {
  auto rows = nlohmann::ordered_json::array();
  for (const Table2Row& row : table) {
    rows.push_back({{"model", row.model},
                    {"stand_in", kStandIn},
                    {"points", row.points},
                    {"points_drawn", row.drawn},
                    {"resolution", row.resolution},
                    {"machine", row.machine},
                    {"fps_published", row.published_fps},
                    {"fps_simulated", row.simulated.fps},
                    {"error", row.error()},
                    {"role", "predicted"},
                    {"bottleneck", row.simulated.bottleneck},
                    {"bottleneck_busy_share", row.simulated.share}});
  }
  return rows;
}

void add_to(Findings& findings, const std::vector<Table2Row>& table) {
  using enum Report::Align;
  findings.report().heading("Table 2: frame rates of models");
  std::vector<std::vector<std::string>> rows;
  for (const Table2Row& row : table) {
    rows.push_back({row.model, fmt::format("{}", row.points), fmt::format("{}", row.drawn),
                    fmt::format("{}", row.resolution), row.machine, fmt::format("{:.1f}", row.published_fps),
                    fmt::format("{:.3f}", row.simulated.fps), fmt::format("{:+.1f} %", 100 * row.error()),
                    text_of_bottleneck(row.simulated)});
  }
  findings.table(
      "EWA normalised per surfel, culled by blocks at the finest level. No parameter is fitted to these.",
      {{"stand-in"},
       {"points", number},
       {"drawn", number},
       {"size", number},
       {"machine"},
       {"published fps", number},
       {"simulated fps", number},
       {"error", number},
       {"bottleneck"}},
      rows);
  findings.report().paragraph(
      "The paper's models and cameras were never published. The models here are stand-ins, made after their "
      "names, with exactly as many points; the camera frames each of them. A frame's time goes with the "
      "points that culling leaves, and these depend on the shape and on the view: part of each error is the "
      "stand-in's, not the machine's.");
}

}  // namespace

std::span<const Table2Model> table2_models() {
  return kModels;
}

traces::Scene table2_scene(const Table2Model& model, const Progress& progress) {
  return traces::parse_scene(fmt::format("surfels = {{ generator = \"{}\", count = {} }}\nhierarchy.culling "
                                         "= \"blocks\"\ncapture.views = 1\n",
                                         model.name, model.points),
                             "table2", progress);
}

double free_video_memory(std::string_view machine) {
  return machine == machine::kRadeon8500 ? 56 : 120;
}

std::vector<Table2Row> table2_rows(Fidelity fidelity, const Progress& progress) {
  std::size_t points = 0;
  for (const Table2Model& model : kModels) points += model.points;
  std::vector<Table2Row> rows;
  double done = 0;
  for (const Table2Model& model : kModels) {
    const double share = static_cast<double>(model.points) / static_cast<double>(points);
    const auto step = [&](double from, double to) {
      return part(progress, done + share * from, done + share * to);
    };
    traces::Scene scene = table2_scene(model, step(0, 0.2));
    double frame = 0;
    for (const auto& [resolution, radeon, ti4400] : model.published) {
      for (const auto& [name, fps] :
           {std::pair(machine::kRadeon8500, radeon), {machine::kGeForce4, ti4400}}) {
        const Machine machine = machine::load(name);
        scene.frame = {.width = resolution, .height = resolution};
        traces::place_planes(scene);
        scene.splatting.video_megabytes = free_video_memory(name);
        const traces::Recording recording = traces::record(scene, machine.numbers);
        Table2Row row =
            row_of(recording.trace, machine, fidelity, step(0.2 + 0.2 * frame, 0.4 + 0.2 * frame));
        row.model = model.name;
        row.points = scene.surfels.size();
        row.drawn = recording.counts.surfels;
        row.resolution = resolution;
        row.published_fps = fps;
        rows.push_back(std::move(row));
        ++frame;
      }
    }
    done += share;
  }
  return rows;
}

double median_error(std::span<const Table2Row> rows) {
  std::vector<double> errors;
  for (const Table2Row& row : rows) errors.push_back(std::abs(row.error()));
  return traces::median(std::span(errors));
}

void reproduce_table2(Findings& findings, const Progress& progress) {
  const std::vector<Table2Row> rows = table2_rows(Fidelity::cycle, progress);
  findings.result("table2", json_of(rows));
  add_to(findings, rows);
  findings.text(fmt::format("median error {:.1f} %\n", 100 * median_error(rows)));
}

}  // namespace splatscope::studies
