#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>

#include "kernels/reference/volume/volume_rendering.h"
#include "kernels/reference/volume/volume_splats.h"
#include "kernels/view.h"
#include "model/command/commands.h"
#include "traces/volumes/volume_scene.h"

// A volume as a GPU of 2002 would have drawn it: Zwicker 2002, section 9. What the host does each frame: it
// chooses the axis of the sheets, shades the voxels, and issues the draws.
namespace splatscope::traces {

struct VolumeTraceSettings {
  double cutoff = 4;  // radial index at which a splat ends (Zwicker 2002, section 7.1)
  kernels::PhongLight light{};
  int texture_length = 0;     // texels along an edge of the Gaussian; 0: Eq. 16's (Ren 2002)
  int texture_bits = 8;       // 1 to 16; no trace file holds more than 8
  bool float_colors = false;  // colour and opacity as four floats a vertex; else 8 bits each
  // Adds up a sheet as strongly as its largest sum allows (volume_sheets.h); false: as it is.
  bool gains = true;
  // Draws voxels of one variance by the program that has it in its constants; false: all by the general one.
  bool shared_variance = true;
  glm::dvec3 background{};  // r g b, behind the volume
};

struct VolumeCounts {
  std::size_t splats = 0;    // drawn
  std::size_t flat = 0;      // of these: flattened across their gradient
  std::size_t left_out = 0;  // not between near and far plane, outside of the frame, or no finite footprint
  std::size_t sheets = 0;    // drawn: those with a splat in the frame
  std::size_t vertex_bytes = 0;
};

struct VolumeTrace : VolumeCounts {
  Trace trace;
};

// One frame of a perspective view. From back to front, for each sheet of the axis most parallel to the line
// of sight: its rectangle of the off-screen surface is cleared, its splats are added up there, the faintest
// first, and the rectangle is composited into the frame. Sums above 1 saturate, where the reference divides
// by them: keep the opacity of a layer seen at the steepest slope below 1.
VolumeTrace volume_trace(const kernels::View& view, const kernels::VolumeSplats& splats,
                         const VolumeTraceSettings& settings);

// Records a scene with a volume. Throws UserError "file:line: ..." where it asks for a prefilter other than
// EWA, which the programs do not compute.
VolumeTrace record(const VolumeScene& scene);

// "1000 splats (100 flat) in 20 sheets, 3 left out, 0.2 MB of vertices".
std::string describe(const VolumeCounts& counts);

}  // namespace splatscope::traces
