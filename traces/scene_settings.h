#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "traces/output_files.h"
#include "traces/scene_keys.h"

namespace splatscope::traces {

// Reads the text of a scene file. Throws UserError "file:line: ..." for wrong TOML, an unknown table or key,
// and a value of the wrong type or out of range.
SceneSettings parse_settings(std::string_view text, std::string_view file);

// The files that the settings name, relative to `folder`: of surfels, or of a volume.
std::vector<NamedFile> files_named(const SceneSettings& settings, const std::filesystem::path& folder);

// That no key of the settings asks for what only a mesh has, where their file turns out to hold points.
// Throws UserError.
void check_points(const SceneSettings& settings, std::string_view file);

// That no key tells how to estimate what the points of their file have. Throws UserError.
void check_complete_points(const SceneSettings& settings, std::string_view file);

// That the settings' camera can see something: what no single key can tell, and what is known only when a
// camera that a scene leaves open was made to frame its surfels. (parse_settings has checked the plane's.)
// Throws UserError.
void check_camera(const SceneSettings& settings, std::string_view file);

}  // namespace splatscope::traces
