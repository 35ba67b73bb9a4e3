#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace splatscope::kernels {

// What a value looks like.
struct VoxelLook {
  double opacity = 0;  // of a path of the cube root of the voxel's cell, in [0, 1]
  glm::dvec3 color{};  // r g b, each in [0, 1]
};

struct TransferPoint {
  double value = 0;
  VoxelLook look;
};

// Opacity and colour by value: straight lines between points, the first and the last point's look beyond
// them.
class TransferFunction {
 public:
  // At least one point, values rising; of two with the same value the later begins a step.
  explicit TransferFunction(std::vector<TransferPoint> points);

  VoxelLook operator()(double value) const;

 private:
  std::vector<TransferPoint> points_;
};

}  // namespace splatscope::kernels
