#pragma once

#include <filesystem>
#include <string>

namespace splatscope::traces {

struct SceneText {
  std::string text;
  std::filesystem::path file;  // for messages, and for finding the files that the scene names
};

// A scene file's text, or that of a ready scene by its name where no such file exists. Throws UserError: no
// such file or scene, unreadable, or larger than 1 MiB.
SceneText read_scene_text(const std::filesystem::path& name_or_path);

}  // namespace splatscope::traces
