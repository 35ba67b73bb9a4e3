#pragma once

#include <span>
#include <string>

#include "studies/short_programs.h"
#include "studies/study.h"

namespace splatscope::studies {

// What the authors of Ren 2002 could have had: shorter programs, and the hardware of their section 9.
void study_exploration(Findings& findings, const Progress& progress);

// The table of programs, as the study prints it.
std::string text_of(std::span<const ProgramRow> rows);

}  // namespace splatscope::studies
