#pragma once

#include <filesystem>

#include "traces/scene_keys.h"

namespace splatscope::traces {

struct Surfels {
  std::vector<Surfel> surfels;  // finite, radius > 0, normal of unit length, color in [0, 1]
  SkipCounts skipped;
  double average_spacing = 0;  // object units, > 0
};

// Makes or loads the surfels that the settings ask for. A surfel file's name is relative to `folder`. What a
// file lacks is estimated; what cannot be drawn is left out and counted. Throws UserError (point_file.h).
Surfels make_surfels(const SceneSettings& settings, const std::filesystem::path& folder);

}  // namespace splatscope::traces
