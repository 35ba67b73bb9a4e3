#include "studies/hierarchy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "studies/reference_comparison.h"
#include "studies/reproduction/table2.h"
#include "studies/run.h"
#include "traces/framing.h"
#include "traces/hierarchy/block_choice.h"
#include "traces/recorder.h"
#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

constexpr std::string_view kModels[] = {"salamander", "chameleon", "wasp", "fiesta"};
constexpr int kBlockSurfels[] = {16, 64, 256, 1024};
constexpr double kDistances[] = {1, 2, 4, 8};

traces::Scene scene_of(std::string_view model) {
  traces::Scene scene = traces::parse_scene(
      fmt::format("surfels.generator = \"{}\"\nhierarchy.culling = \"blocks\"\n", model), std::string(model));
  scene.splatting.video_megabytes = free_video_memory(machine::kGeForce4);
  return scene;
}

// From so near that part of the model is out of the frame.
traces::Scene from_near(traces::Scene scene) {
  scene.camera.eye = scene.camera.target + 0.45 * (scene.camera.eye - scene.camera.target);
  scene.camera.near = 1e-3 * scene.camera.far;
  return scene;
}

double rate(const Trace& trace, const Machine& machine) {
  return run_frame(trace, machine, Fidelity::throughput).timing->frames_per_second();
}

// Rates are those per surfel, and do not ask for good weights; pictures are normalised per pixel, and need
// none.
traces::Recording for_rates(traces::Scene scene, const Machine& machine) {
  scene.splatting.algorithm = traces::Algorithm::ewa_per_surfel;
  scene.capture.views = 1;
  scene.capture.frame_size = 64;
  scene.capture.corner_weights = false;
  return traces::record(scene, machine.numbers);
}
std::vector<Frame> pictures_of(traces::Scene scene, const Machine& machine) {
  scene.splatting.algorithm = traces::Algorithm::ewa_per_pixel;
  std::vector<Frame> frames;
  run_frame(traces::record(scene, machine.numbers).trace, machine, Fidelity::functional, {},
            [&](const Frame& frame) { frames.push_back(frame); });
  return frames;
}

double difference(const Frame& a, const Frame& b) {
  std::vector<unsigned char> drawn;
  for (std::size_t pixel = 0; pixel < a.depth.size(); ++pixel)
    drawn.push_back(a.color(pixel)[3] > 0 || b.color(pixel)[3] > 0);
  return psnr(picture_of(a), picture_of(b), drawn);
}

std::string percent(std::size_t part, std::size_t whole) {
  return fmt::format("{:.1f} %", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::string>;
using enum Report::Align;

void study_culling(Findings& findings, const Machine& machine, const Progress& progress) {
  std::vector<Cells> cells;
  Json results = Json::array();
  constexpr std::size_t kRows = 2 * std::size(kModels) + std::size(kBlockSurfels);
  const auto add = [&](const std::string& name, const traces::Scene& scene) {
    const CullingRow row = culling_row(scene, machine);
    cells.push_back({name, fmt::format("{}", row.surfels), percent(row.could_go.outside, row.surfels),
                     percent(row.outside, row.surfels), percent(row.could_go.facing_away, row.surfels),
                     percent(row.facing_away, row.surfels), fmt::format("{}", row.blocks),
                     fmt::format("{}", row.draws), fmt::format("{:.2f}", row.fps_all),
                     fmt::format("{:.2f}", row.fps)});
    results.push_back({{"view", name},
                       {"surfels", row.surfels},
                       {"outside", row.could_go.outside},
                       {"outside_culled", row.outside},
                       {"facing_away", row.could_go.facing_away},
                       {"facing_away_culled", row.facing_away},
                       {"blocks_drawn", row.blocks},
                       {"draws_of_a_pass", row.draws},
                       {"fps_culling_off", row.fps_all},
                       {"fps", row.fps}});
    tell(progress, cells.size(), kRows);
  };
  traces::Scene first;
  for (const std::string_view model : kModels) {
    const traces::Scene scene = scene_of(model);
    add(std::string(model), scene);
    add(fmt::format("{}, near", model), from_near(scene));
    if (first.surfels.empty()) first = scene;
  }
  for (const int surfels : kBlockSurfels) {
    first.hierarchy.block_surfels = surfels;
    add(fmt::format("{}, blocks of {}", kModels[0], surfels), first);
  }
  findings.table(
      "Culling by blocks, 512 x 512: surfels outside of the frustum and, inside, facing away; how many of "
      "all were culled as such; draws of a pass; frame rates without culling and with it.",
      {{"view"},
       {"surfels", number},
       {"outside", number},
       {"culled", number},
       {"away", number},
       {"culled", number},
       {"blocks", number},
       {"draws", number},
       {"fps off", number},
       {"fps", number}},
      cells);
  findings.say("\n");
  findings.result("culling", std::move(results));
}

void study_levels(Findings& findings, const Machine& machine, const Progress& progress) {
  const traces::Scene scene = scene_of(kModels[0]);
  std::vector<Cells> cells;
  Json results = Json::array();
  for (const double times : kDistances) {
    const LevelRow row = level_row(scene, times, machine);
    cells.push_back({fmt::format("{:g}", times), fmt::format("{:.2f} px", row.spacing_pixels),
                     fmt::format("{}", row.surfels), fmt::format("{:.2f}", row.fps_finest),
                     fmt::format("{:.1f} dB", row.psnr_finest), fmt::format("{:.2f}", row.fps),
                     fmt::format("{:.1f} dB", row.psnr),
                     fmt::format("{}", fmt::join(row.surfels_by_level, ", "))});
    results.push_back({{"distance", times},
                       {"spacing_pixels", row.spacing_pixels},
                       {"surfels", row.surfels},
                       {"surfels_by_level", row.surfels_by_level},
                       {"fps_finest", row.fps_finest},
                       {"psnr_finest_decibels", row.psnr_finest},
                       {"fps", row.fps},
                       {"psnr_decibels", row.psnr}});
    tell(progress, cells.size(), std::size(kDistances));
  }
  findings.table(
      "The salamander from further away: the finest level alone, and with a surfel a pixel where a coarser "
      "level has as many. Rates of frames normalised per surfel; pictures normalised per pixel, against the "
      "double-precision reference.",
      {{"distance"},
       {"spacing", number},
       {"surfels", number},
       {"fps finest", number},
       {"PSNR finest", number},
       {"fps", number},
       {"PSNR", number},
       {"by level, the finest first", number}},
      cells);
  findings.say("\n");
  findings.result("levels", std::move(results));
}

void study_progressive(Findings& findings, const Machine& machine) {
  const std::vector<ProgressiveRow> rows = progressive_rows(scene_of(kModels[0]), machine);
  std::vector<Cells> cells;
  Json results = Json::array();
  std::vector<Findings::Picture> pictures;
  for (const ProgressiveRow& row : rows) {
    const std::string number = fmt::format("{}", cells.size() + 1);
    cells.push_back({number, fmt::format("{}", row.surfels), fmt::format("{:.2f}", row.milliseconds),
                     fmt::format("{:.1f} dB", row.psnr)});
    results.push_back(
        {{"surfels", row.surfels}, {"milliseconds", row.milliseconds}, {"psnr_decibels", row.psnr}});
    pictures.push_back(
        {"progressive-" + number, fmt::format("frame {}: {} surfels", number, row.surfels), row.picture});
  }
  findings.table(
      "Frames of a progressive rendering: times of those normalised per surfel; pictures normalised "
      "per pixel, each against the last.",
      {{"frame"}, {"surfels", number}, {"ms", number}, {"PSNR", number}}, cells);
  findings.pictures(pictures);
  findings.result("progressive", std::move(results));
}

}  // namespace

SurfelsOfAView classify(const traces::Scene& scene) {
  const kernels::View view = traces::view_of(scene.camera, scene.frame);
  SurfelsOfAView counts;
  for (const traces::Surfel& surfel : scene.surfels) {
    const glm::dvec3 p = view.camera_space(glm::dvec3(surfel.position));
    const bool inside = p.z >= view.near_plane && p.z <= view.far_plane &&
                        std::abs(p.x) * view.eta <= 0.5 * view.width * p.z &&
                        std::abs(p.y) * view.eta <= 0.5 * view.height * p.z;
    if (!inside) {
      ++counts.outside;
    } else {
      counts.facing_away += glm::dot(view.camera_direction(glm::dvec3(surfel.normal)), p) >= 0;
    }
  }
  return counts;
}

CullingRow culling_row(traces::Scene scene, const Machine& machine) {
  CullingRow row;
  row.surfels = scene.surfels.size();
  row.could_go = classify(scene);
  const traces::CapturedWeights weights =
      traces::uniform_weights(scene.surfels.size(), scene.splatting.gamma);
  scene.hierarchy.culling = traces::Culling::off;
  row.fps_all = rate(traces::record(scene, weights).trace, machine);
  scene.hierarchy.culling = traces::Culling::blocks;
  const traces::Recording recording = traces::record(scene, weights);
  row.fps = rate(recording.trace, machine);
  row.outside = recording.counts.blocks.outside_frustum;
  row.facing_away = recording.counts.blocks.facing_away;
  row.blocks = recording.counts.blocks.blocks;
  row.draws =
      static_cast<std::size_t>(std::ranges::count_if(
          recording.trace.commands, [](const Command& c) { return std::holds_alternative<Draw>(c); })) /
      2;
  return row;
}

LevelRow level_row(traces::Scene scene, double times, const Machine& machine) {
  const glm::dvec3 away = (times - 1) * (scene.camera.eye - scene.camera.target);
  scene.camera.eye += away;
  traces::place_planes(scene);
  LevelRow row;
  const kernels::View view = traces::view_of(scene.camera, scene.frame);
  const traces::LdcTree tree = traces::build_ldc_tree(scene.surfels, scene.hierarchy.block_surfels);
  row.spacing_pixels =
      view.eta * tree.levels.front().spacing / glm::length(scene.camera.eye - scene.camera.target);
  row.fps_finest = rate(for_rates(scene, machine).trace, machine);
  // Not one picture against the other: of a model that is small on the screen, neither is exact.
  const kernels::ScreenSpacePicture reference = screen_space_reference(scene);
  row.psnr_finest = psnr(pictures_of(scene, machine).back(), reference);
  scene.hierarchy.levels = true;
  const traces::Recording recording = for_rates(scene, machine);
  row.fps = rate(recording.trace, machine);
  row.surfels = recording.counts.surfels;
  row.surfels_by_level = recording.counts.blocks.surfels_by_level;
  row.psnr = psnr(pictures_of(scene, machine).back(), reference);
  return row;
}

std::vector<ProgressiveRow> progressive_rows(traces::Scene scene, const Machine& machine) {
  scene.hierarchy.progressive = true;
  const FrameRun run = run_frame(for_rates(scene, machine).trace, machine, Fidelity::throughput);
  const std::vector<Frame> frames = pictures_of(scene, machine);
  const traces::LdcTree tree = traces::build_ldc_tree(scene.surfels, scene.hierarchy.block_surfels);
  const auto chosen = traces::choose_blocks(tree, traces::view_of(scene.camera, scene.frame), scene.splatting,
                                            scene.hierarchy);
  std::vector<ProgressiveRow> rows;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    rows.push_back({.surfels = chosen[i].counts.surfels,
                    .milliseconds = static_cast<double>(run.timing->frame_cycles[i]) /
                                    (1000 * machine.clock.core_megahertz),
                    .psnr = difference(frames[i], frames.back()),
                    .picture = picture_of(frames[i])});
  }
  return rows;
}

void study_hierarchy(Findings& findings, const Progress& progress) {
  findings.report().heading("Blocks and levels of the LDC tree: section 6.2");
  const Machine machine = machine::load(machine::kGeForce4);
  study_culling(findings, machine, part(progress, 0, 0.6));
  study_levels(findings, machine, part(progress, 0.6, 0.9));
  study_progressive(findings, machine);
}

}  // namespace splatscope::studies
