#include <fmt/format.h>

#include <cmath>

#include "studies/reproduction/depth_offset.h"
#include "studies/reproduction/reproduction.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

constexpr double kSpacing = 0.1;  // object units; of both surfaces, and so z_t

constexpr int kColumnsOfA = 18;
constexpr int kColumnsOfB = 86;

// A square of surfels that faces the eye, checkered.
void add_square(const glm::dvec3& center, int columns, int rows, const glm::vec3& color,
                std::vector<traces::Surfel>& surfels) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float shade = (row / 4 + column / 4) % 2 == 0 ? 1.0f : 0.6f;
      const glm::dvec3 offset{column - 0.5 * (columns - 1), row - 0.5 * (rows - 1), 0};
      surfels.push_back({glm::vec3(center + kSpacing * offset),
                         {0, 0, -1},
                         static_cast<float>(std::sqrt(2.0) * kSpacing),
                         shade * color});
    }
  }
}

constexpr int kRow = 150;               // of the pictures: through A
constexpr int kSpacingsInSection = 12;  // z_t, about as large as the paper draws it

// The depth buffer at the row, seen from above: x and z in camera space.
Plot::Series depth_image(const kernels::View& view, const Frame& frame) {
  Plot::Series series{.name = "depth image", .joined = false};
  for (int x = 0; x < view.width; ++x) {
    const double depth = frame.depth_value(static_cast<std::size_t>(kRow * view.width + x));
    if (depth == 1) continue;
    const double z = view.z_of(depth);
    series.x.push_back(z * (x + 0.5 - view.center().x) / view.eta);
    series.y.push_back(z);
  }
  return series;
}

// Fig. 4 as the paper draws it.
Plot section(const std::string& title, const traces::Scene& scene, const Frame& frame) {
  const kernels::View view = traces::view_of(scene.camera, scene.frame);
  Plot plot{.title = title, .x_label = "camera x, object units", .y_label = "camera z, object units"};
  plot.same_scale = true;
  const double reach = std::sqrt(2.0) * kSpacing;
  // From the first to the last of a square's surfels, to the ends of their quads.
  const auto square = [&](const std::string& name, std::size_t first, std::size_t last) {
    const glm::vec3 from = scene.surfels[first].position, to = scene.surfels[last].position;
    return Plot::Series{name, {from.x - reach, to.x + reach}, {from.z, to.z}};
  };
  constexpr std::size_t kEndOfA = kColumnsOfA * kColumnsOfA;
  const Plot::Series a = square("surface A", 0, kEndOfA - 1);
  const Plot::Series rays{"rays along A's edges", {2 * a.x[0], 0, 2 * a.x[1]}, {2 * a.y[0], 0, 2 * a.y[1]}};
  plot.series = {a, square("surface B", kEndOfA, scene.surfels.size() - 1), rays, depth_image(view, frame)};
  return plot;
}

}  // namespace

// The scene that the paper draws in section: surface A, beside the camera's axis, hides a part of surface B.
// Camera and sizes are a reconstruction.
traces::Scene figure4_scene() {
  traces::Scene scene = traces::parse_scene(
      fmt::format("[camera]\neye = [0, 0, 0]\ntarget = [0, 0, 1]\nfov_y_degrees = 70\nnear = 1\nfar = 20\n"
                  "[splatting]\ndepth_offset = {}\n",
                  kSpacing),
      "two-surfaces.toml");
  scene.surfels.clear();
  add_square({1.4, 0.9, 4}, kColumnsOfA, kColumnsOfA, {1, 0.75, 0.35}, scene.surfels);
  add_square({0, 0, 7}, kColumnsOfB, kColumnsOfB, {0.4, 0.65, 1}, scene.surfels);
  return scene;
}

void reproduce_figure4(Findings& findings, const Progress& progress) {
  const traces::Scene scene = figure4_scene();
  const Machine machine = machine::load(machine::kGeForce4);
  const VisibleSurface surface = visible_surface(scene);
  const traces::CapturedWeights weights =
      traces::capture_weights(scene, machine.numbers, part(progress, 0, 0.8));
  findings.report().heading("Fig. 4: the depth offset along camera z and along viewing rays");
  compare_schemes("fig4", scene, weights, machine, surface, findings);

  const auto draw_section = [&](const std::string& letter, traces::DepthOffsetScheme scheme) {
    const OffsetRun run =
        run_with_offset(scene, scheme, kSpacingsInSection * kSpacing, weights, machine, surface);
    findings.plot("fig4" + letter, section(fmt::format("Fig. 4{}: in section, z_t drawn {} times as large",
                                                       letter, kSpacingsInSection),
                                           scene, run.rendered.frame));
  };
  draw_section("a", traces::DepthOffsetScheme::camera_z);
  draw_section("b", traces::DepthOffsetScheme::viewing_ray);
}

}  // namespace splatscope::studies
