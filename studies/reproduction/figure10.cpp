#include "studies/reproduction/figure10.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/bounds.h"
#include "studies/reference_comparison.h"
#include "studies/run.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

constexpr double kGammas[] = {0.2, 0.3, 0.4, 0.5, 0.55, 0.6, 0.65, 0.73, 1};

// The half of the surfels with the smaller x, as a user might mark a part of the model.
void mark_half(traces::Scene& scene) {
  kernels::Box box;
  for (const traces::Surfel& surfel : scene.surfels) box.add(glm::dvec3(surfel.position));
  const double margin = 0.02 * glm::length(box.size());
  scene.capture.box_min = box.low - margin;
  scene.capture.box_max = box.high + margin;
  scene.capture.box_max.x = box.middle().x;
}

void draw_line(glm::dvec2 from, glm::dvec2 to, Image& image) {
  const double steps = std::ceil(glm::length(to - from));
  for (double i = 0; i <= steps; ++i) {
    const glm::ivec2 pixel = glm::floor(glm::mix(from, to, i / std::max(steps, 1.0)));
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= image.width || pixel.y >= image.height) continue;
    image.at(pixel.x, pixel.y) = {1, 1, 0, 1};
  }
}

// The edges of the box of the capture, yellow.
void draw_box(const traces::Scene& scene, Image& image) {
  const kernels::View view = traces::view_of(scene.camera, scene.frame);
  const kernels::Box box{scene.capture.box_min, scene.capture.box_max};
  const auto window = [&](unsigned corner) { return view.window(view.camera_space(box.corner(corner))); };
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (const unsigned bit : {1u, 2u, 4u}) {
      if ((corner & bit) == 0) draw_line(window(corner), window(corner | bit), image);
    }
  }
}

class Figure10 {
 public:
  Figure10(Findings& findings, const Progress& progress) : findings_(findings), progress_(progress) {}

  void run() {
    findings_.report().heading("Fig. 10: normalisation");
    ways();
    corners();
    gammas();
    findings_.result("fig10", std::move(results_));
  }

 private:
  // Adds a picture and how far it is from the reference.
  void add(const std::string& name, const std::string& caption, const Frame& frame,
           const kernels::ScreenSpacePicture& reference) {
    const double decibels = psnr(frame, reference);
    pictures_.push_back({"fig10-" + name, caption, picture_of(frame)});
    findings_.text(fmt::format("fig10 {:<22} {:>5.1f} dB  {}\n", name, decibels, caption));
    results_[name] = {{"psnr_decibels", decibels}};
  }

  void show() { findings_.pictures(std::exchange(pictures_, {})); }

  void ways() {
    const traces::Scene scene = figure10_model();
    const kernels::ScreenSpacePicture reference = screen_space_reference(scene);
    add("direct", "a) without normalisation: every weight is 1",
        draw_frame(scene, traces::uniform_weights(scene.surfels.size(), 1), machine_), reference);
    traces::Scene marked = scene;
    mark_half(marked);
    const traces::CapturedWeights boxed =
        traces::capture_weights(marked, machine_.numbers, part(progress_, 0.05, 0.2));
    add("box",
        fmt::format("b) weights captured in the box alone: {} surfels, {} outside", boxed.captured,
                    boxed.outside_box),
        draw_frame(scene, boxed, machine_), reference);
    draw_box(marked, pictures_.back().image);
    const traces::CapturedWeights all =
        traces::capture_weights(scene, machine_.numbers, part(progress_, 0.2, 0.4));
    add("per-surfel",
        fmt::format("c) per surfel: {} captured, {} seen from no view", all.captured, all.unseen),
        draw_frame(scene, all, machine_), reference);
    traces::Scene per_pixel = scene;
    per_pixel.splatting.algorithm = traces::Algorithm::ewa_per_pixel;
    add("per-pixel", "normalised per pixel",
        draw_frame(per_pixel, traces::uniform_weights(scene.surfels.size(), scene.splatting.gamma), machine_),
        reference);
    results_["surfels"] = {{"captured", all.captured}, {"unseen", all.unseen}};
    results_["box_surfels"] = {{"captured", boxed.captured}, {"outside_box", boxed.outside_box}};
    show();
  }

  void corners() {
    traces::Scene scene = figure10_sheet();
    const kernels::ScreenSpacePicture reference = screen_space_reference(scene);
    for (const bool on : {false, true}) {
      scene.capture.corner_weights = on;
      const traces::CapturedWeights weights = traces::capture_weights(scene, machine_.numbers);
      add(on ? "corner-weights" : "no-corner-weights",
          on ? fmt::format("a weight for each vertex of the {} surfels at edges", weights.at_edges)
             : "one weight a surfel, at the edges too",
          draw_frame(scene, weights, machine_), reference);
    }
    show();
  }

  void gammas() {
    traces::Scene scene = figure10_model();
    scene.capture.views = 12;
    const auto rows =
        sweep_gamma(scene, kGammas, machine_, screen_space_reference(scene), part(progress_, 0.5, 1));
    Plot plot{.title = "gamma against clamping", .x_label = "gamma", .y_label = "percent, or dB"};
    plot.series = {
        {"pixels saturated, %", {}, {}}, {"weights from clamped sums, %", {}, {}}, {"PSNR, dB", {}, {}}};
    findings_.text(fmt::format("fig10 {:>6} {:>10} {:>9} {:>9}   (0: the program chooses {:.2f})\n", "gamma",
                               "saturated", "clamped", "PSNR", scene.splatting.gamma));
    auto list = nlohmann::ordered_json::array();
    for (const GammaRow& row : rows) {
      findings_.text(fmt::format("      {:>6.2f} {:>9.2f}% {:>8.2f}% {:>6.1f} dB\n", row.gamma,
                                 100 * row.saturated, 100 * row.clamped, row.psnr));
      list.push_back({{"gamma", row.gamma},
                      {"saturated", row.saturated},
                      {"clamped", row.clamped},
                      {"psnr_decibels", row.psnr}});
      const double values[] = {100 * row.saturated, 100 * row.clamped, row.psnr};
      for (std::size_t i = 0; i < plot.series.size(); ++i) {
        plot.series[i].x.push_back(row.gamma);
        plot.series[i].y.push_back(values[i]);
      }
    }
    results_["gamma"] = std::move(list);
    results_["suitable_gamma"] = scene.splatting.gamma;
    findings_.plot("fig10-gamma", plot);
  }

  Findings& findings_;
  const Progress& progress_;
  const Machine machine_ = machine::load(machine::kGeForce4);
  std::vector<Findings::Picture> pictures_;
  nlohmann::ordered_json results_;
};

// Of the pixels on which weights were summed, those at the largest value of 8 bits.
double saturated_share(const Frame& frame) {
  std::size_t drawn = 0, saturated = 0;
  for (std::size_t pixel = 0; pixel < frame.depth.size(); ++pixel) {
    const float sum = frame.color(pixel)[3];
    drawn += sum > 0;
    saturated += sum >= 1;
  }
  return static_cast<double>(saturated) / static_cast<double>(std::max<std::size_t>(drawn, 1));
}

// A clamped sum is 1, and gamma the weight.
double clamped_share(const traces::CapturedWeights& weights, double gamma) {
  const auto clamped = std::ranges::count(weights.weights, traces::equal_weights(gamma));
  return static_cast<double>(clamped) / static_cast<double>(std::max<std::size_t>(weights.weights.size(), 1));
}

}  // namespace

// The paper's model is not known: a stand-in of another table, sampled coarsely so that the splats show.
traces::Scene figure10_model() {
  return traces::parse_scene("[surfels]\ngenerator = \"chameleon\"\ncount = 30000\n", "lizard.toml");
}

// A sheet with edges, in the middle of the picture.
traces::Scene figure10_sheet() {
  return traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 40\nrows = 40\nchecker_square = 5\n"
      "checker_light = [0.7, 0.75, 0.8]\nchecker_dark = [0.4, 0.25, 0.2]\n"
      "[camera]\neye = [0, 34, 40]\ntarget = [0, 0, 2]\nfov_y_degrees = 55\n",
      "sheet.toml");
}

std::vector<GammaRow> sweep_gamma(const traces::Scene& scene, std::span<const double> gammas,
                                  const Machine& machine, const kernels::ScreenSpacePicture& reference,
                                  const Progress& progress) {
  std::vector<GammaRow> rows;
  traces::Scene changed = scene;
  for (const double gamma : gammas) {
    changed.splatting.gamma = gamma;
    const traces::CapturedWeights equal = traces::uniform_weights(scene.surfels.size(), gamma);
    const Trace sums =
        traces::splat_trace({scene.surfels, equal.weights}, traces::view_of(scene.camera, scene.frame),
                            changed.splatting, {.prefilter = false, .sum_weights = true});
    const traces::CapturedWeights captured = traces::capture_weights(changed, machine.numbers);
    rows.push_back({gamma, saturated_share(draw_frame(sums, machine)), clamped_share(captured, gamma),
                    psnr(draw_frame(changed, captured, machine), reference)});
    tell(progress, rows.size(), gammas.size());
  }
  return rows;
}

void reproduce_figure10(Findings& findings, const Progress& progress) {
  Figure10(findings, progress).run();
}

}  // namespace splatscope::studies
