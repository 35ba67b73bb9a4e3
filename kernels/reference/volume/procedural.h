#pragma once

#include <functional>

#include "kernels/reference/volume/volume.h"

// Volumes that need no file. All are centred at the object space's origin; values in [0, 1].
namespace splatscope::kernels {

// The grid with `value(position)` at every voxel.
Volume filled(Volume grid, const std::function<double(const glm::dvec3&)>& value);

// The test signal of Marschner and Lobb (1994), f_M = 6 and alpha = 0.25, on [-1, 1]^3; n^3 voxels, n >= 2
// (40 in their paper, close to its Nyquist frequency).
Volume marschner_lobb(int n);

// Concentric shells in [-1, 1]^3: cos^2 of the distance from the centre, `shells` of them from 0 to 1, and 0
// outside. n^3 voxels.
Volume concentric_shells(int n, int shells);

// 1 everywhere.
Volume constant_volume(const glm::ivec3& size, const glm::dvec3& spacing);

// The zebra texture of Fig. 14 and 15: stripes that bend, of about `period` units, on the square [-1, 1]^2;
// `columns` x `rows` x `layers` voxels, whose edges along x and y are 2/columns and 2/rows and along z the
// smaller of both. The paper prints no texture: this is a stand-in, the same picture at any size.
Volume zebra_texture(int columns, int rows, int layers, double period);

// The zebra texture's value at a point of its square.
double zebra(double x, double y, double period);

// A stand-in for a CT scan of a human head: skin, skull with its openings, jaw, teeth, brain. Air is 0, soft
// tissue 0.25 to 0.4, bone 0.7 to 1, with a little noise as scanners have it. The scan fills [-1, 1]^2 in x
// (left to right) and y (front to back) and the height that a head of this width has, along z.
Volume head_stand_in(const glm::ivec3& size);

}  // namespace splatscope::kernels
