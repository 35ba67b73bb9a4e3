#include "studies/short_programs.h"

#include <algorithm>
#include <map>
#include <string>

#include "kernels/splat_programs.h"
#include "model/isa/analysis.h"
#include "studies/reference_comparison.h"
#include "traces/weight_capture.h"

namespace splatscope::studies {
namespace {

bool is_live(const isa::Program& program) {
  return std::ranges::none_of(isa::analyze(program).instructions, &isa::InstructionAnalysis::dead);
}

// A scene by each program on one machine. Its weights are captured once: without prefilter, they are the same
// for all.
class Drawing {
 public:
  Drawing(traces::Scene scene, Machine machine) : scene_(std::move(scene)), machine_(std::move(machine)) {
    scene_.splatting.algorithm = traces::Algorithm::ewa_per_surfel;
    weights_ = traces::capture_weights(scene_, machine_.numbers);
  }
  FrameRun by(std::string_view program, Fidelity fidelity) {
    scene_.splatting.ewa_program = program;
    return run_frame(traces::record(scene_, weights_).trace, machine_, fidelity);
  }

 private:
  traces::Scene scene_;
  Machine machine_;
  traces::CapturedWeights weights_;
};

// As a screen shows it.
Image shown(const Frame& frame) {
  Image image = picture_of(frame);
  for (auto& pixel : image.pixels) {
    for (float& channel : pixel) channel = std::clamp(channel, 0.0f, 1.0f);
  }
  return image;
}

// dB of the picture by each program against the first.
std::vector<double> psnr_by_program(Drawing drawing, std::span<const std::string_view> names) {
  const Image first = shown(drawing.by(names[0], Fidelity::functional).rendered.frame);
  std::vector<double> decibels;
  for (const std::string_view name : names) {
    decibels.push_back(psnr(shown(drawing.by(name, Fidelity::functional).rendered.frame), first));
  }
  return decibels;
}

}  // namespace

std::vector<ProgramRow> program_rows(const traces::Scene& scene, std::span<const std::string_view> names,
                                     Fidelity fidelity, int surfels, const Progress& progress) {
  const kernels::SplatSums reference = single_surface_reference(scene);
  traces::Scene one_weight = scene;
  one_weight.capture.corner_weights = false;
  // In binary32: what the program itself does to the picture.
  const Machine in_float = with_frame(machine::load(kBothMachines[0]), FrameFormat::float32);
  const auto apart = psnr_by_program({scene, in_float}, names);
  const auto apart_one = psnr_by_program({one_weight, in_float}, names);
  std::vector<ProgramRow> rows;
  std::map<std::string_view, Drawing> drawings;
  for (const std::string_view name : kBothMachines) {
    drawings.emplace(name, Drawing(scene, machine::load(name)));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const kernels::SplatProgram& splats = kernels::ewa_program(names[i]);
    const isa::Program program = kernels::load_program(splats.file);
    ProgramRow row{.name = names[i],
                   .slots = isa::slot_count(program),
                   .live = is_live(program),
                   .rates = {},
                   .ieee = kernels::splat_errors(splats, Arithmetic::ieee, 2002, surfels),
                   .nv20 = kernels::splat_errors(splats, Arithmetic::nv20, 2003, surfels),
                   .psnr_paper = apart[i],
                   .psnr_paper_one_weight = apart_one[i],
                   .psnr_reference = 0,
                   .timing = {}};
    for (const std::string_view name : kBothMachines) {
      const FrameRun run = drawings.at(name).by(names[i], fidelity);
      row.rates.push_back(rate_of(*run.timing));
      if (name != kBothMachines[0]) continue;
      row.psnr_reference = psnr(run.rendered.frame, reference);
      row.timing = *run.timing;
    }
    rows.push_back(std::move(row));
    tell(progress, rows.size(), names.size());
  }
  return rows;
}

}  // namespace splatscope::studies
