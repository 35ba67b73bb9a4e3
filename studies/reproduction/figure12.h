#pragma once

#include "model/machine/machine.h"
#include "model/output/frame.h"
#include "studies/reference_comparison.h"
#include "studies/study.h"
#include "traces/scene.h"

// Models with textures of high frequency (Ren 2002, Fig. 12).
namespace splatscope::studies {

struct ModelPicture {
  Frame frame;
  kernels::ScreenSpacePicture reference;
  Comparison comparison;
};

// What `machine` draws of a model, beside double precision.
ModelPicture draw_model(const traces::Scene& scene, const Machine& machine, const Progress& progress = {});

void reproduce_figure12(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
