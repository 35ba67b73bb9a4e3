#pragma once

#include <span>
#include <vector>

#include "kernels/reference/screen_space.h"
#include "model/machine/machine.h"
#include "studies/study.h"
#include "traces/scene.h"

// Normalisation of the splats' weights (Ren 2002, section 7): Fig. 10, and what the text says beside it.
namespace splatscope::studies {

// A model with few surfels, and a sheet with edges.
traces::Scene figure10_model();
traces::Scene figure10_sheet();

// One value of gamma (7.2): what clamping does to the capture of weights, and that to the picture.
struct GammaRow {
  double gamma = 0;
  double saturated = 0;  // of the pixels drawn without prefilter as for a capture: alpha is at its largest
  double clamped = 0;    // of the surfels: their weight is that of a clamped sum
  double psnr = 0;       // of the normalised picture, dB against `reference`
};
std::vector<GammaRow> sweep_gamma(const traces::Scene& scene, std::span<const double> gammas,
                                  const Machine& machine, const kernels::ScreenSpacePicture& reference,
                                  const Progress& progress = {});

void reproduce_figure10(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
