#include "studies/reproduction/figure3.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "studies/image_io.h"
#include "studies/run.h"
#include "traces/neighbours.h"
#include "traces/scene_keys.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

// The paper's model is not known.
traces::Scene knot(int count) {
  return traces::parse_scene(fmt::format("[surfels]\ngenerator = \"torus-knot\"\ncount = {}\n", count),
                             "knot.toml");
}
constexpr std::size_t kSurfels = 20000;
constexpr int kDenseSurfels = 400000;

traces::Scene uneven(const traces::Scene& dense) {
  traces::Scene scene = dense;
  scene.surfels.clear();
  std::ranges::sample(dense.surfels, std::back_inserter(scene.surfels), kSurfels, std::mt19937(1));
  traces::estimate_radii(scene.surfels, traces::default_settings().surfels.neighbours);
  scene.splatting.depth_offset = traces::average_spacing(scene.surfels);
  return scene;
}

constexpr double kSides[] = {0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3};

double mean_radius(const traces::Scene& scene) {
  double sum = 0;
  for (const traces::Surfel& surfel : scene.surfels) sum += surfel.radius;
  return sum / static_cast<double>(scene.surfels.size());
}

// Near is white; holes are red.
Image picture_of(const DepthImage& depth) {
  const auto [low, high] = [&] {
    double nearest = 1, furthest = 0;
    for (std::size_t i = 0; i < depth.frame.depth.size(); ++i) {
      const double value = depth.frame.depth_value(i);
      nearest = std::min(nearest, value);
      if (value < 1) furthest = std::max(furthest, value);
    }
    return std::pair(nearest, furthest);
  }();
  Image image(static_cast<int>(depth.frame.width), static_cast<int>(depth.frame.height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double value = depth.frame.depth_value(i);
    const auto gray = static_cast<float>(value < 1 ? 1 - 0.8 * (value - low) / (high - low) : 0);
    image.pixels[i] = {gray, gray, gray, 1};
  }
  for (const std::size_t i : depth.holes) image.pixels[i] = {1, 0, 0, 1};
  return image;
}

}  // namespace

Figure3Scenes figure3_scenes() {
  Figure3Scenes scenes{.even = knot(kSurfels), .uneven = {}, .dense = knot(kDenseSurfels)};
  scenes.dense.camera = scenes.even.camera;
  scenes.uneven = uneven(scenes.dense);
  return scenes;
}

Trace depth_trace(traces::Scene scene, double side) {
  for (traces::Surfel& surfel : scene.surfels) surfel.radius *= static_cast<float>(0.5 * side);
  const std::vector<traces::VertexWeights> weights(scene.surfels.size());
  Trace trace = traces::splat_trace({scene.surfels, weights}, traces::view_of(scene.camera, scene.frame),
                                    scene.splatting, {});
  std::erase_if(trace.commands, [](const Command& command) {
    const Draw* draw = std::get_if<Draw>(&command);
    return draw != nullptr && draw->state.color_write;
  });
  return trace;
}

std::vector<DepthImage> depth_images(const traces::Scene& scene, std::span<const double> sides,
                                     const VisibleSurface& surface, const Machine& machine) {
  const kernels::View view = traces::view_of(scene.camera, scene.frame);
  const double most = scene.splatting.depth_offset + mean_radius(scene);
  std::vector<DepthImage> images;
  for (const double side : sides) {
    DepthImage image{side, draw_frame(depth_trace(scene, side), machine), 0, {}};
    for (int y = 0; y < surface.height; ++y) {
      for (int x = 0; x < surface.width; ++x) {
        if (!is_inside(surface, x, y)) continue;
        ++image.inside_pixels;
        const auto pixel = static_cast<std::size_t>(y * surface.width + x);
        const double depth = image.frame.depth_value(pixel);
        const glm::dvec2 ray = (glm::dvec2(x, y) + 0.5 - view.center()) / view.eta;
        const double behind = (view.z_of(depth) - surface.depth[pixel]) * std::sqrt(glm::dot(ray, ray) + 1);
        if (depth >= 1 || behind > most) image.holes.push_back(pixel);
      }
    }
    images.push_back(std::move(image));
  }
  return images;
}

void reproduce_figure3(Findings& findings, const Progress& progress) {
  const Figure3Scenes scenes = figure3_scenes();
  const VisibleSurface surface = visible_surface(scenes.dense);
  if (progress) progress(0.7);

  findings.report().heading("Fig. 3: the depth image of visibility splatting");
  Plot plot{.title = "Holes in the depth image",
            .x_label = "side of the opaque quads, h",
            .y_label = "holes, percent of the pixels inside",
            .log_y = true};
  nlohmann::ordered_json results;
  findings.text(
      fmt::format("{:<6}{:<8}{:>8} {:>8} {:>9}\n", "fig3", "surfels", "side, h", "holes", "inside"));
  for (const auto& [name, scene] : {std::pair("even", &scenes.even), {"uneven", &scenes.uneven}}) {
    const std::vector<DepthImage> images =
        depth_images(*scene, kSides, surface, machine::load(machine::kGeForce4));
    std::vector<Findings::Picture> pictures;
    Plot::Series series{name, {}, {}};
    auto list = nlohmann::ordered_json::array();
    for (const DepthImage& image : images) {
      const double percent =
          100 * static_cast<double>(image.holes.size()) / static_cast<double>(image.inside_pixels);
      findings.text(fmt::format("{:<6}{:<8}{:>8} {:>8} {:>8.3f}%\n", "", name, image.side, image.holes.size(),
                                percent));
      list.push_back(
          {{"side", image.side}, {"holes", image.holes.size()}, {"inside_pixels", image.inside_pixels}});
      series.x.push_back(image.side);
      series.y.push_back(percent);
      if (image.side == 1 || image.side == 2) {
        pictures.push_back({fmt::format("fig3-{}-{}h", name, image.side),
                            fmt::format("{} surfels, quads of side {}h: {} holes, red", name, image.side,
                                        image.holes.size()),
                            picture_of(image)});
      }
    }
    plot.series.push_back(std::move(series));
    findings.pictures(pictures);
    results[name] = std::move(list);
  }
  findings.plot("fig3-holes", plot);
  findings.result("fig3", std::move(results));
}

}  // namespace splatscope::studies
