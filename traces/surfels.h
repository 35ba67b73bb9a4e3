#pragma once

#include <filesystem>

#include "traces/output_files.h"
#include "traces/scene_keys.h"

namespace splatscope::traces {

struct Surfels {
  std::vector<Surfel> surfels;  // finite, radius > 0, normal of unit length, color in [0, 1]
  SkipCounts skipped;
  EstimateCounts estimated;
  MeshCounts mesh;
  Camera camera;                   // the settings', completed but for its clip planes (framing.h)
  double average_spacing = 0;      // object units, > 0
  std::vector<NamedFile> files{};  // that a mesh was read from
};

// Makes, samples or loads the surfels that the settings ask for. A file's name is relative to `folder`. What
// a file lacks is estimated; what cannot be drawn is left out and counted. Throws UserError (point_file.h,
// models/mesh_file.h).
Surfels make_surfels(const SceneSettings& settings, const std::filesystem::path& folder,
                     const std::function<void(double)>& progress = {});

// Exactly as many surfels as `source` asks for from the mesh or procedural model that it names, what was
// wrong with the mesh, and what is wrong with the surfels. `files_read` is told the files of a mesh when it
// is read, before the work on it; what it throws ends that.
struct SampledModel {
  std::vector<Surfel> surfels;
  MeshCounts mesh;
  std::size_t copies = 0;       // surfels that are equal to an earlier one: the mesh has no more places
  std::size_t zero_radius = 0;  // which cannot be drawn
};
SampledModel sample_source(const SurfelSource& source, const std::filesystem::path& folder,
                           const std::function<void(double)>& progress = {},
                           const std::function<void(const std::vector<NamedFile>&)>& files_read = {});

// "1000 surfels from 1 triangles, 955 at the place of another".
std::string describe(const SampledModel& sampled);

}  // namespace splatscope::traces
