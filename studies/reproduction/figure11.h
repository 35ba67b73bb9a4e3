#pragma once

#include "kernels/reference/splat_sums.h"
#include "model/machine/machine.h"
#include "model/output/frame.h"
#include "studies/study.h"
#include "traces/scene.h"

// The checkerboard by the three algorithms (Ren 2002, Fig. 11).
namespace splatscope::studies {

struct CheckerboardPicture {
  Frame frame;
  double psnr = 0;  // dB against the reference
};

// What `machine` draws of a scene with a single surface, by the scene's algorithm.
CheckerboardPicture draw_checkerboard(const traces::Scene& scene, const kernels::SplatSums& reference,
                                      const Machine& machine, const Progress& progress = {});

void reproduce_figure11(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
