#pragma once

#include <filesystem>
#include <string>

#include "studies/study.h"
#include "traces/volumes/volume_scene.h"

namespace splatscope::studies {

enum class Precision {
  single_precision,  // the fast renderer
  double_precision   // its yardstick
};

// Draws a volume in software and writes frame.png, frame.exr and results.json into the folder. Returns what
// there is to say, in lines. Throws UserError where the folder cannot be written.
std::string run_volume(const traces::VolumeScene& scene, Precision precision,
                       const std::filesystem::path& folder, const Progress& progress = {});

}  // namespace splatscope::studies
