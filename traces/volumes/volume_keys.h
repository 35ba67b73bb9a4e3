#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "kernels/reference/volume/transfer_function.h"
#include "kernels/reference/volume/volume_rendering.h"

namespace splatscope::traces {

enum class VolumeGenerator { marschner_lobb, shells, zebra, head, constant };

// [volume] of a scene file.
struct VolumeKeys {
  std::string file;  // empty: the generator
  VolumeGenerator generator = VolumeGenerator::marschner_lobb;
  glm::dvec3 voxels{};                           // of the generator, along x, y and z; 0: its own number
  std::vector<double> x, y, z;                   // places of a rectilinear grid; none: evenly
  std::string positions;                         // file of a curvilinear grid's places; empty: none
  std::string samples;                           // file of an irregular set; empty: a grid
  bool mirror = false;                           // in x
  std::vector<kernels::TransferPoint> transfer;  // none: a ramp over the values
  double kernel_variance = 1;
  double surface_low = 0, surface_high = 0;  // values drawn as flat kernels
  double surface_flatness = 0;               // s of Zwicker 2002, Eq. 37
  kernels::VolumeSettings rendering;
  glm::dvec3 background{};
};

}  // namespace splatscope::traces
