#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/run.h"

// The published results on the simulated machines, side by side with the published figures.
namespace splatscope::studies {

// What can be reproduced, by name: "table1".
std::vector<std::string_view> reproduction_names();

// Runs the reproductions of the given names (none: all), prints their tables to standard output and writes
// results.json, pictures and report.html into `folder`. Throws UserError for an unknown name or a folder that
// cannot be written, before any work.
void reproduce(const std::vector<std::string>& names, const std::filesystem::path& folder,
               const Progress& progress = {});

}  // namespace splatscope::studies
