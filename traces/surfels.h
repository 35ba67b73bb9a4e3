#pragma once

#include <filesystem>

#include "traces/scene_keys.h"

namespace splatscope::traces {

struct Surfels {
  std::vector<Surfel> surfels;  // finite, radius > 0, normal of unit length, color in [0, 1]
  SkipCounts skipped;
  MeshCounts mesh;
  Camera camera;               // the settings', completed (framing.h)
  double average_spacing = 0;  // object units, > 0
};

// Makes, samples or loads the surfels that the settings ask for. A file's name is relative to `folder`. What
// a file lacks is estimated; what cannot be drawn is left out and counted. Throws UserError (point_file.h,
// models/mesh_file.h).
Surfels make_surfels(const SceneSettings& settings, const std::filesystem::path& folder,
                     const std::function<void(double)>& progress = {});

// Exactly as many surfels as `source` asks for from the mesh or procedural model that it names, and what was
// wrong with the mesh.
struct SampledModel {
  std::vector<Surfel> surfels;
  MeshCounts mesh;
};
SampledModel sample_source(const SurfelSource& source, const std::filesystem::path& folder,
                           const std::function<void(double)>& progress = {});

}  // namespace splatscope::traces
