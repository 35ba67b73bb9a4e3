#include "traces/scene_text.h"

#include <fmt/format.h>

#include "model/error.h"
#include "model/input_file.h"
#include "traces/ready_scenes.h"

namespace splatscope::traces {
SceneText read_scene_text(const std::filesystem::path& name_or_path) {
  std::error_code error;
  if (std::filesystem::exists(name_or_path, error))
    return {read_text_file(name_or_path, "a scene file"), name_or_path};
  std::string names;
  for (const EmbeddedFile& ready : ready_scenes()) {
    const std::filesystem::path file(ready.name);
    if (name_or_path == file || name_or_path == file.stem()) return {std::string(ready.text), file};
    names += fmt::format("{}{}", names.empty() ? "" : ", ", file.stem().string());
  }
  throw UserError(name_or_path.string(), 0,
                  fmt::format("no such file, expected a scene file or the name of a ready scene: {}", names));
}

}  // namespace splatscope::traces
