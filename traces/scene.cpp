#include "traces/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "model/error.h"
#include "traces/gamma.h"
#include "traces/ready_scenes.h"
#include "traces/scene_settings.h"
#include "traces/surfels.h"

namespace splatscope::traces {
namespace {

std::string read_text(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMost = 1 << 20;  // bytes: a scene file is written by hand
  std::ifstream in(path, std::ios::binary);
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  if (!in || !regular) throw UserError(path.string(), 0, "cannot be read, expected a scene file");
  if (std::filesystem::file_size(path, error) > kMost)
    throw UserError(path.string(), 0, "is larger than 1 MiB, expected a scene file");
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file) {
  const SceneSettings settings = parse_settings(text, file.string());
  Scene scene;
  scene.name = file.stem().string();
  scene.camera = settings.camera;
  scene.frame = {settings.width, settings.height};
  scene.splatting = settings.splatting;
  scene.capture = settings.capture;
  Surfels surfels = make_surfels(settings, file.parent_path());
  scene.surfels = std::move(surfels.surfels);
  scene.skipped = surfels.skipped;
  scene.splatting.depth_offset = settings.depth_offset > 0 ? settings.depth_offset : surfels.average_spacing;
  if (!(scene.splatting.gamma > 0)) scene.splatting.gamma = suitable_gamma(scene.surfels, scene.splatting);
  return scene;
}

Scene load_scene(const std::filesystem::path& name_or_path) {
  std::error_code error;
  if (!std::filesystem::exists(name_or_path, error)) {
    for (const EmbeddedFile& ready : ready_scenes()) {
      const std::filesystem::path file(ready.name);
      if (name_or_path == file || name_or_path == file.stem()) return parse_scene(ready.text, file);
    }
    std::string names;
    for (const EmbeddedFile& ready : ready_scenes())
      names +=
          fmt::format("{}{}", names.empty() ? "" : ", ", std::filesystem::path(ready.name).stem().string());
    throw UserError(
        name_or_path.string(), 0,
        fmt::format("no such file, expected a scene file or the name of a ready scene: {}", names));
  }
  return parse_scene(read_text(name_or_path), name_or_path);
}

std::string describe(const SkipCounts& skipped) {
  if (skipped.total() == 0) return "none left out";
  std::string reasons;
  const auto add = [&](std::size_t count, std::string_view reason) {
    if (count > 0) reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
  };
  add(skipped.not_finite, "not finite");
  add(skipped.zero_radius, "of radius 0");
  add(skipped.zero_normal, "without a normal");
  return fmt::format("{} left out ({})", skipped.total(), reasons);
}

std::string_view name(Algorithm algorithm) {
  constexpr std::string_view kNames[] = {"no-ewa", "ewa-per-pixel", "ewa-per-surfel"};
  return kNames[static_cast<int>(algorithm)];
}

}  // namespace splatscope::traces
