#pragma once

#include <string_view>

#include "traces/scene_keys.h"

namespace splatscope::traces {

// Reads the text of a scene file. Throws UserError "file:line: ..." for wrong TOML, an unknown table or key,
// and a value of the wrong type or out of range.
SceneSettings parse_settings(std::string_view text, std::string_view file);

}  // namespace splatscope::traces
