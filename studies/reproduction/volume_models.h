#pragma once

#include <string>

#include "kernels/reference/volume/volume_splats.h"
#include "kernels/view.h"

// Stand-ins for the three volumes of Zwicker 2002, Fig. 16: formulas, on grids of the sizes
// that the paper prints.
namespace splatscope::studies {

struct VolumeModel {
  std::string name;      // "head", "engine", "foot"
  std::string stand_in;  // what is drawn in its place
  glm::ivec3 size{};
  kernels::VolumeSplats splats;  // bone or casing as flat kernels, the rest as volume splats
  kernels::View view;            // of a square frame
};

// With `scale` times the voxels along each axis. Opacities are such that no sheet saturates.
VolumeModel volume_head(int frame, double scale = 1);
VolumeModel volume_engine(int frame, double scale = 1);
VolumeModel volume_foot(int frame, double scale = 1);

}  // namespace splatscope::studies
