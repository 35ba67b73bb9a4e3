#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/reference/volume/transfer_function.h"
#include "kernels/reference/volume/volume.h"
#include "kernels/reference/volume/volume_rendering.h"
#include "kernels/reference/volume/volume_splats.h"
#include "kernels/view.h"
#include "traces/output_files.h"
#include "traces/scene_text.h"

namespace splatscope::traces {

// What a user wants drawn of a volume: a scene file with [volume]. Places, samples and the view count from
// the middle of the volume.
struct VolumeScene {
  std::string name;                            // the scene file's name without folder and ending
  std::string file;                            // for messages
  std::vector<NamedFile> files;                // others that it was read from
  int prefilter_line = 0;                      // of volume.prefilter
  kernels::Volume volume;                      // of irregular data: their values in a row
  kernels::VoxelPlaces places;                 // of a rectilinear or curvilinear grid; else empty
  std::vector<kernels::VolumeSample> samples;  // of irregular data; else none
  kernels::TransferFunction transfer{std::vector<kernels::TransferPoint>(1)};
  double kernel_variance = 1;
  kernels::Flattening flattening;
  kernels::View view;
  kernels::VolumeSettings settings;
  glm::dvec3 background{};

  kernels::VolumeSplats splats() const;
};

// Whether a scene has [volume]. Throws UserError as load_scene does.
bool has_volume(const SceneText& scene);

// Reads a scene file with [volume], or a ready scene by its name. What the file leaves open of the camera is
// chosen to frame the volume's box (framing.h). Throws UserError as load_scene and read_nrrd do, and where
// there is no [volume].
VolumeScene load_volume_scene(const std::filesystem::path& name_or_path);

// The same from text; `file` is for messages and for finding the volume's file.
VolumeScene parse_volume_scene(std::string_view text, const std::filesystem::path& file);

}  // namespace splatscope::traces
