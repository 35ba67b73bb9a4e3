#include <fmt/format.h>

#include <algorithm>

#include "studies/reproduction/depth_offset.h"
#include "studies/reproduction/reproduction.h"

namespace splatscope::studies {
namespace {

// z_t in spacings, from too small to too large.
constexpr double kOffsets[] = {0.03, 0.06, 0.12, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24, 32};

double percent(std::size_t part, std::size_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

std::string text_of(const std::vector<OffsetRow>& rows) {
  std::string text = fmt::format("fig5  {:>13} {:>8} {:>8} {:>10} {:>10} {:>12}\n", "z_t, spacings", "holes",
                                 "torn", "hidden", "leaking", "leaking px");
  for (const auto& [spacings, counts] : rows) {
    text += fmt::format(
        "      {:>13} {:>8} {:>7.2f}% {:>9.3f}% {:>9.3f}% {:>11.2f}%\n", spacings, counts.holes,
        percent(counts.torn_pixels, counts.surface_pixels), percent(counts.surface_hidden, counts.of_surface),
        percent(counts.leaking, counts.kept), percent(counts.leaking_pixels, counts.surface_pixels));
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<OffsetRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& [spacings, counts] : rows) {
    list.push_back({{"spacings", spacings},
                    {"holes", counts.holes},
                    {"inside_pixels", counts.inside_pixels},
                    {"torn_pixels", counts.torn_pixels},
                    {"surface_pixels", counts.surface_pixels},
                    {"of_surface", counts.of_surface},
                    {"surface_hidden", counts.surface_hidden},
                    {"kept", counts.kept},
                    {"leaking", counts.leaking},
                    {"leaking_pixels", counts.leaking_pixels}});
  }
  return list;
}

Plot plot_of(const std::vector<OffsetRow>& rows) {
  Plot plot{.title = "z_t from too small to too large, along viewing rays",
            .x_label = "z_t, average spacings",
            .y_label = "percent",
            .log_x = true,
            .log_y = true};
  plot.series = {{"torn: pixels with less than half of their surface's weights", {}, {}},
                 {"hidden: of the visible surface's fragments", {}, {}},
                 {"leaking: of the fragments kept, those of surfaces behind", {}, {}}};
  for (const auto& [spacings, counts] : rows) {
    const double values[] = {percent(counts.torn_pixels, counts.surface_pixels),
                             percent(counts.surface_hidden, counts.of_surface),
                             percent(counts.leaking, counts.kept)};
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
      plot.series[i].x.push_back(spacings);
      plot.series[i].y.push_back(values[i]);
    }
  }
  return plot;
}

}  // namespace

// The paper's model and view are not known. A knot has silhouettes before surfaces of its own everywhere; few
// surfels and a wide angle close by make z_t several pixels at the picture's edge.
traces::Scene figure5_scene() {
  return traces::parse_scene(
      "[surfels]\ngenerator = \"torus-knot\"\ncount = 20000\n"
      "[camera]\neye = [0.2, 0.3, 1.5]\ntarget = [0, 0, 0]\nfov_y_degrees = 70\n",
      "knot.toml");
}

std::vector<OffsetRow> sweep_offset(const traces::Scene& scene, std::span<const double> spacings,
                                    const traces::CapturedWeights& weights, const Machine& machine,
                                    const VisibleSurface& surface, const Progress& progress) {
  std::vector<OffsetRow> rows;
  for (const double factor : spacings) {
    const double z_t = factor * scene.splatting.depth_offset;
    rows.push_back({factor, run_with_offset(scene, traces::DepthOffsetScheme::viewing_ray, z_t, weights,
                                            machine, surface)
                                .counts});
    tell(progress, rows.size(), spacings.size());
  }
  return rows;
}

void reproduce_figure5(Findings& findings, const Progress& progress) {
  const traces::Scene scene = figure5_scene();
  const Machine machine = machine::load(machine::kGeForce4);
  const VisibleSurface surface = visible_surface(scene);
  const traces::CapturedWeights weights =
      traces::capture_weights(scene, machine.numbers, part(progress, 0, 0.4));
  findings.report().heading("Fig. 5: the two depth offset schemes on a model");
  compare_schemes("fig5", scene, weights, machine, surface, findings);
  const std::vector<OffsetRow> rows =
      sweep_offset(scene, kOffsets, weights, machine, surface, part(progress, 0.5, 1));
  findings.text(text_of(rows));
  std::vector<Findings::Picture> extremes;
  for (const auto& [name, spacings] : {std::pair("small", 0.12), std::pair("large", 24.0)}) {
    const OffsetRun run = run_with_offset(scene, traces::DepthOffsetScheme::viewing_ray,
                                          spacings * scene.splatting.depth_offset, weights, machine, surface);
    extremes.push_back({fmt::format("fig5-too-{}", name), fmt::format("z_t of {} spacings", spacings),
                        picture_of(run.rendered.frame)});
  }
  findings.pictures(extremes);
  findings.plot("fig5-sweep", plot_of(rows));
  findings.result("fig5_sweep", json_of(rows));
}

}  // namespace splatscope::studies
