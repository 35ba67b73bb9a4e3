#pragma once

#include "studies/study.h"

namespace splatscope::studies {

// The published results that can be reproduced on the simulated machines, by the names that the papers give
// them.
std::span<const Study> reproductions();

// One file each beside this one.
void reproduce_figure4(Findings& findings, const Progress& progress);
void reproduce_figure5(Findings& findings, const Progress& progress);
void reproduce_figure8(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
