#pragma once

#include "studies/study.h"

namespace splatscope::studies {

// What the authors of Ren 2002 could have had: shorter programs, and other hardware.
void study_exploration(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
