#include "studies/software_comparison.h"

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <array>

#include "kernels/reference/fast_splatting.h"
#include "studies/growth.h"
#include "studies/measure.h"
#include "studies/reference_comparison.h"
#include "traces/framing.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kSingle = "software, single";
constexpr std::string_view kDouble = "software, double";
constexpr std::string_view kRenderers[] = {kSingle, kDouble, kBothMachines[0], kBothMachines[1]};

// Seconds of a renderer's frames over their pixels.
Plot::Series series_of(std::span<const SoftwareRow> rows, std::string_view renderer) {
  Plot::Series series{.name = std::string(renderer)};
  for (const SoftwareRow& row : rows) {
    if (row.renderer != renderer) continue;
    series.x.push_back(static_cast<double>(row.resolution) * row.resolution);
    series.y.push_back(row.seconds);
  }
  return series;
}

Plot frame_plot(const std::vector<SoftwareRow>& rows) {
  Plot plot{.title = "Frame time against resolution",
            .x_label = "pixels",
            .y_label = "seconds a frame",
            .log_x = true,
            .log_y = true};
  for (const std::string_view renderer : kRenderers) plot.series.push_back(series_of(rows, renderer));
  return plot;
}

void add_table(Findings& findings, const std::vector<SoftwareRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const SoftwareRow& row : rows) {
    cells.push_back({std::string(row.renderer), fmt::format("{}", row.resolution),
                     fmt::format("{:.1f}", 1000 * row.seconds),
                     fmt::format("{:.2f}", row.splats_per_second / 1e6),
                     fmt::format("{:.2f}", growth(rows, row.renderer))});
  }
  findings.table(
      "Points of the model a second, those that face away or are hidden included. Software: seconds of this "
      "host; machines: simulated. Growth: slope of log(time) over log(pixels).",
      {{"renderer"}, {"size", number}, {"ms a frame", number}, {"M splats/s", number}, {"growth", number}},
      cells);
}

nlohmann::ordered_json json_of(const std::vector<SoftwareRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const SoftwareRow& row : rows) {
    list.push_back({{"renderer", row.renderer},
                    {"resolution", row.resolution},
                    {"seconds", row.seconds},
                    {"splats_per_second", row.splats_per_second},
                    {"growth", growth(rows, row.renderer)}});
  }
  return list;
}

}  // namespace

std::vector<SoftwareRow> software_rows(traces::Scene scene, std::span<const int> resolutions, int repeats,
                                       Fidelity fidelity, const Progress& progress) {
  std::vector<SoftwareRow> rows;
  const auto points = static_cast<double>(scene.surfels.size());
  const auto add = [&](std::string_view renderer, double seconds) {
    rows.push_back({renderer, scene.frame.width, seconds, points / seconds});
    tell(progress, rows.size(), std::size(kRenderers) * resolutions.size());
  };
  const double offset = scene.splatting.depth_offset, cutoff = scene.splatting.cutoff;
  const std::vector<kernels::Surfel> surfels = reference_surfels(scene);
  kernels::FastSplatting fast(surfels);
  for (const int resolution : resolutions) {
    scene.frame = {.width = resolution, .height = resolution};
    traces::place_planes(scene);
    const kernels::View view = traces::view_of(scene.camera, scene.frame);
    add(kSingle, median_seconds(repeats, [&] {
          fast.draw(view, {.cutoff = cutoff, .depth_offset = offset, .cull_back_faces = true});
        }));
    add(kDouble, median_seconds(repeats, [&] {
          kernels::screen_space_ewa(view, surfels,
                                    {.filter = {.cutoff = cutoff, .shape = kernels::CutoffShape::circle},
                                     .depth_offset = offset,
                                     .cull_back_faces = true});
        }));
    for (const std::string_view name : kBothMachines) {
      const Machine machine = machine::load(name);
      add(name, run_frame(traces::record(scene, machine.numbers).trace, machine, fidelity).timing->seconds);
    }
  }
  return rows;
}

double growth(std::span<const SoftwareRow> rows, std::string_view renderer) {
  const Plot::Series series = series_of(rows, renderer);
  return log_log_slope(series.x, series.y);
}

void study_software(Findings& findings, const Progress& progress) {
  traces::Scene scene = traces::parse_scene("surfels.generator = \"salamander\"\ncapture.views = 1\n",
                                            "software", part(progress, 0, 0.2));
  const std::vector<SoftwareRow> rows =
      software_rows(scene, std::array{256, 512, 1024}, 5, Fidelity::throughput, part(progress, 0.2, 1));
  findings.report().heading("Software against hardware: section 8");
  findings.text(fmt::format("{} points; software on {} threads of this host\n", scene.surfels.size(),
                            oneapi::tbb::this_task_arena::max_concurrency()));
  add_table(findings, rows);
  findings.plot("software", frame_plot(rows));
  findings.result("software", json_of(rows));
}

}  // namespace splatscope::studies
