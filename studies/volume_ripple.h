#pragma once

#include "studies/study.h"

// How constant a layer of constant voxels is, by the cutoff of its splats (Zwicker 2002, section 7.1).
namespace splatscope::studies {

// Largest deviation of a layer's opacity from what its voxels have, as a part of that. `pitch`: pixels
// between the voxels, seen straight on without perspective.
double layer_ripple(double cutoff, double pitch);

void study_volume_ripple(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
