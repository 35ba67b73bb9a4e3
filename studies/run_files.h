#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/run.h"
#include "traces/output_files.h"

// The names of the files that a run writes into its folder.
namespace splatscope::studies {

// Of the last of `frames` ("frame.png") and of the ones before it ("frame-000.png", ...).
std::string picture_name(std::size_t number, std::size_t frames);

// The files beside its own that `opened` was read from: what a scene names, and what they name in turn.
std::vector<traces::NamedFile> files_of(const Opened& opened);

// Throws UserError where one of `files` has the place of a result that a run may write into `folder`, or that
// stands there and would go away; or where a folder has that place.
void expect_apart_from_results(const std::vector<traces::NamedFile>& files,
                               const std::filesystem::path& folder);

}  // namespace splatscope::studies
