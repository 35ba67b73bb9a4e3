#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

// Points spread evenly over the unit sphere: a spherical Fibonacci lattice.
namespace splatscope::kernels {

struct SpherePoint {
  glm::dvec3 place{};  // of unit length: also the normal
  glm::dvec3 along{};  // the tangent along the circle of latitude about z, of unit length
};

// Number i, 0 <= i < count.
inline SpherePoint sphere_point(int i, int count) {
  const double z = 1 - (2 * i + 1.0) / count, ring = std::sqrt(1 - z * z);
  const double angle = 2 * std::numbers::pi * i / std::numbers::phi;
  return {{ring * std::cos(angle), ring * std::sin(angle), z}, {-std::sin(angle), std::cos(angle), 0}};
}

// Mean distance between neighbours.
inline double sphere_spacing(int count) {
  return std::sqrt(4 * std::numbers::pi / count);
}

}  // namespace splatscope::kernels
