#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traces/output_files.h"

// The names of the files that a run writes into its folder.
namespace splatscope::studies {

// Of the last of `frames` ("frame.png") and of the ones before it ("frame-000.png", ...).
std::string picture_name(std::size_t number, std::size_t frames);

// What the argument `what` of a command line names, a scene or a trace, and the files that the scene names.
// Throws UserError where the scene's text is wrong.
std::vector<traces::NamedFile> files_of_input(const std::string& what, const std::string& scene_or_trace);

// Throws UserError where one of `files` has the place of a result that a run may write into `folder`.
void expect_apart_from_results(const std::vector<traces::NamedFile>& files,
                               const std::filesystem::path& folder);

// Removes what an earlier run wrote into `folder`, by the `files` of its results.json, but for those of the
// names in `kept`, so that the folder holds one run. What no run has listed stays, whatever its name.
void remove_earlier_results(const std::filesystem::path& folder, const std::vector<std::string>& kept);

}  // namespace splatscope::studies
