#include "studies/picture_quality.h"

#include <fmt/format.h>

#include "model/input_file.h"
#include "studies/measure.h"
#include "studies/run.h"
#include "traces/gamma.h"
#include "traces/splat_trace.h"
#include "traces/weight_capture.h"

namespace splatscope::studies {
namespace {

constexpr int kSurfels = 100000;
constexpr std::string_view kFiles[] = {"bunny.obj", "armadillo.off", "dragon.ply", "elephant.off"};
constexpr std::string_view kGenerators[] = {"sphere", "salamander", "chameleon"};

// How a scene splats: its table `splatting`.
struct Setting {
  std::string_view name;
  std::string_view toml;
};
constexpr Setting kSettings[] = {{"defaults", ""}, {"c = 3, sigma = 0.58", "cutoff = 3\nsigma = 0.5774\n"}};

// Sums of splats in double precision, as a machine with an exact frame buffer would leave them.
Frame frame_of(const kernels::SplatSums& sums) {
  NumberFormats formats;
  formats.frame = FrameFormat::float32;
  Frame frame(static_cast<std::uint32_t>(sums.width), static_cast<std::uint32_t>(sums.height), formats);
  for (std::size_t i = 0; i < sums.sums.size(); ++i) {
    for (int c = 0; c < 4; ++c)
      frame.colors32[i][static_cast<std::size_t>(c)] = static_cast<float>(sums.sums[i][c]);
  }
  return frame;
}

// The reference's renderer with weights per surfel; of a surfel with four weights their mean.
kernels::ScreenSpacePicture draw_exactly(const traces::Scene& scene,
                                         std::span<const traces::VertexWeights> weights) {
  std::vector<kernels::Surfel> surfels = reference_surfels(scene);
  for (std::size_t k = 0; k < surfels.size(); ++k) {
    const traces::VertexWeights& w = weights[k];
    surfels[k].weight = 0.25 * (double{w[0]} + w[1] + w[2] + w[3]);
  }
  return screen_space_reference(scene, surfels);
}

// Eq. 5 as it stands: the picture that the sums are, not divided.
kernels::ScreenSpacePicture undivided(kernels::ScreenSpacePicture picture) {
  for (std::size_t i = 0; i < picture.sums.size(); ++i)
    picture.normalized[i] = glm::min(glm::dvec3(picture.sums[i]), 1.0);
  return picture;
}

nlohmann::ordered_json json_of(std::string_view setting, const QualityRow& row) {
  return {{"splatting", setting},
          {"model", row.name},
          {"surfels", row.surfels},
          {"per_pixel", json_of(row.per_pixel)},
          {"exact_weights_double", json_of(row.exact)},
          {"captured_weights_double", json_of(row.captured)},
          {"captured_weights_float_frame", json_of(row.float_frame)},
          {"per_surfel", json_of(row.per_surfel)},
          {"per_surfel_against_same_weights_double", json_of(row.same_weights)},
          {"capture_seconds", row.capture_seconds},
          {"unseen", row.unseen}};
}

void add_table(Findings& findings, const std::vector<std::vector<std::string>>& rows) {
  using enum Report::Align;
  findings.table(
      fmt::format(
          "{} surfels at 512 x 512. PSNR in dB over the surface, and off edges, of both "
          "normalisations against the reference, which divides in each pixel; per surfel also against "
          "Eq. 5 in double precision with the same weights; off edges also from exact weights in double "
          "precision, from captured weights in double precision, and from these with a float frame "
          "buffer; seconds of the capture of weights.",
          kSurfels),
      {{"model"},
       {"splatting"},
       {"per pixel", number},
       {"off edges", number},
       {"holes", number},
       {"per surfel", number},
       {"off edges", number},
       {"holes", number},
       {"Eq. 5", number},
       {"exact", number},
       {"captured", number},
       {"float frame", number},
       {"capture, s", number}},
      rows);
}

std::vector<std::string> cells(std::string_view setting, const QualityRow& r) {
  const auto decibels = [](double value) { return fmt::format("{:.1f}", value); };
  return {r.name,
          std::string(setting),
          decibels(r.per_pixel.psnr),
          decibels(r.per_pixel.psnr_off_edges),
          fmt::format("{}", r.per_pixel.holes),
          decibels(r.per_surfel.psnr),
          decibels(r.per_surfel.psnr_off_edges),
          fmt::format("{}", r.same_weights.holes),
          decibels(r.same_weights.psnr),
          decibels(r.exact.psnr_off_edges),
          decibels(r.captured.psnr_off_edges),
          decibels(r.float_frame.psnr_off_edges),
          fmt::format("{:.1f}", r.capture_seconds)};
}

std::vector<ModelScene> all_models() {
  std::vector<ModelScene> models = real_models(kModelsFolder);
  for (const std::string_view generator : kGenerators)
    models.push_back({std::string(generator), fmt::format("generator = \"{}\"\n", generator)});
  return models;
}

}  // namespace

std::vector<ModelScene> real_models(const std::filesystem::path& folder) {
  std::vector<ModelScene> models;
  for (const std::string_view file : kFiles) {
    const std::filesystem::path path = std::filesystem::absolute(folder / file);
    std::error_code error;
    if (std::filesystem::exists(path, error))
      models.push_back({path.stem().string(), fmt::format("file = {}\n", toml_string(path.string()))});
  }
  return models;
}

QualityRow quality_of(const std::string& name, traces::Scene scene, const Machine& machine,
                      const Progress& progress) {
  QualityRow row;
  row.name = name;
  row.surfels = scene.surfels.size();
  const kernels::ScreenSpacePicture reference = screen_space_reference(scene);
  row.reference = picture_of(reference);

  const auto start = HostClock::now();
  const traces::CapturedWeights captured =
      traces::capture_weights(scene, machine.numbers, part(progress, 0, 0.8));
  row.capture_seconds = seconds_since(start);
  row.unseen = captured.unseen;
  std::vector<traces::VertexWeights> exact;
  for (const double sum : traces::filter_sums(scene.surfels, scene.splatting, scene.surfels))
    exact.push_back(traces::equal_weights(1 / sum));

  row.exact = compare(frame_of(draw_exactly(scene, exact)), reference);
  const kernels::ScreenSpacePicture same_weights = draw_exactly(scene, captured.weights);
  row.captured = compare(frame_of(same_weights), reference);
  const Frame unrounded = draw_frame(scene, captured, with_frame(machine, FrameFormat::float32));
  row.float_frame = compare(unrounded, reference);
  const Frame frame = draw_frame(scene, captured, machine);
  const auto draw_unrounded = [&] { return Frame(unrounded); };
  row.per_surfel = compare(frame, reference, draw_unrounded);
  row.same_weights = compare(frame, undivided(same_weights), draw_unrounded);
  row.picture = picture_of(frame);
  scene.splatting.algorithm = traces::Algorithm::ewa_per_pixel;
  const Trace per_pixel = traces::record(scene, machine.numbers).trace;
  row.per_pixel = compare(draw_frame(per_pixel, machine), per_pixel, machine, reference);
  if (progress) progress(1);
  return row;
}

void study_quality(Findings& findings, const Progress& progress) {
  const Machine machine = machine::load(machine::kGeForce4);
  const std::vector<ModelScene> models = all_models();
  findings.report().heading("Pictures of models against the double-precision reference");
  if (const std::size_t there = models.size() - std::size(kGenerators); there < std::size(kFiles))
    findings.text(fmt::format("{} of {} real models are in {}/ (./fetch-models): the others are left out\n",
                              there, std::size(kFiles), kModelsFolder));
  auto list = nlohmann::ordered_json::array();
  std::vector<std::vector<std::string>> table;
  const double steps = static_cast<double>(std::size(kSettings) * models.size());
  for (const auto& [setting, splatting] : kSettings) {
    for (const ModelScene& model : models) {
      const traces::Scene scene = traces::parse_scene(
          fmt::format("[surfels]\n{}count = {}\n[splatting]\n{}", model.toml, kSurfels, splatting),
          model.name + ".toml");
      const double done = static_cast<double>(list.size());
      const QualityRow row =
          quality_of(model.name, scene, machine, part(progress, done / steps, (done + 1) / steps));
      list.push_back(json_of(setting, row));
      table.push_back(cells(setting, row));
      if (splatting.empty()) {
        findings.pictures({{"quality-" + row.name, row.name + ", normalised per surfel", row.picture},
                           {"quality-" + row.name + "-reference", "reference", row.reference}});
      }
    }
  }
  findings.result("quality", list);
  add_table(findings, table);
}

}  // namespace splatscope::studies
