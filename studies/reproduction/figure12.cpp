#include "studies/reproduction/figure12.h"

#include <fmt/format.h>

#include "studies/picture_quality.h"
#include "studies/run.h"

namespace splatscope::studies {
namespace {

struct Shown {
  ModelScene model;
  std::string what;
};

// The paper's four models were never published: stand-ins of our own under their names, as for Table 2. Real
// models, where ./fetch-models has put them, with solid patterns of high frequency.
std::vector<Shown> shown_models() {
  std::vector<Shown> shown;
  for (const std::string_view name : {"chameleon", "wasp", "salamander", "fiesta"})
    shown.push_back({{std::string(name), fmt::format("generator = \"{}\"\n", name)}, "stand-in"});
  constexpr std::string_view kPatterns[] = {"zebra", "scales", "marble", "spots"};
  for (const ModelScene& model : real_models(kModelsFolder)) {
    const std::string_view pattern = kPatterns[shown.size() % std::size(kPatterns)];
    shown.push_back({{model.name, model.toml + fmt::format("pattern = \"{}\"\n", pattern)},
                     fmt::format("real model, {}", pattern)});
  }
  return shown;
}

}  // namespace

ModelPicture draw_model(const traces::Scene& scene, const Machine& machine, const Progress& progress) {
  kernels::ScreenSpacePicture reference = screen_space_reference(scene);
  const Trace trace = traces::record(scene, machine.numbers, progress).trace;
  Frame frame = draw_frame(trace, machine);
  const Comparison comparison = compare(frame, trace, machine, reference);
  return {std::move(frame), std::move(reference), comparison};
}

void reproduce_figure12(Findings& findings, const Progress& progress) {
  const Machine machine = machine::load(machine::kGeForce4);
  const std::vector<Shown> models = shown_models();
  std::vector<Findings::Comparison> pictures;
  auto list = nlohmann::ordered_json::array();
  std::string text;
  for (const auto& [model, what] : models) {
    const double done = static_cast<double>(pictures.size()), all = static_cast<double>(models.size());
    const traces::Scene scene = traces::parse_scene("[surfels]\n" + model.toml, model.name + ".toml");
    const ModelPicture drawn = draw_model(scene, machine, part(progress, done / all, (done + 1) / all));
    const Comparison& c = drawn.comparison;
    pictures.push_back({"fig12-" + model.name,
                        fmt::format("{} ({}), {} surfels", model.name, what, scene.surfels.size()),
                        picture_of(drawn.frame), picture_of(drawn.reference),
                        difference_picture(drawn.frame, drawn.reference)});
    text += fmt::format(
        "fig12 {:<11} {:<20} {:>7} surfels  {:>5.1f} dB  {:>5.1f} dB off edges  {:>2} holes  {:>3} "
        "rounded to black\n",
        model.name, what, scene.surfels.size(), c.psnr, c.psnr_off_edges, c.holes, c.rounded_to_black);
    list.push_back({{"model", model.name},
                    {"what", what},
                    {"surfels", scene.surfels.size()},
                    {"psnr_decibels", c.psnr},
                    {"psnr_off_edges_decibels", c.psnr_off_edges},
                    {"holes", c.holes},
                    {"rounded_to_black", c.rounded_to_black}});
  }
  findings.report().heading("Fig. 12: models with textures of high frequency");
  findings.text(text);
  findings.compare(pictures);
  findings.result("fig12", list);
}

}  // namespace splatscope::studies
