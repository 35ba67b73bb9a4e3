#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"

// For tests and benchmarks: a unit sphere of points spread evenly (a Fibonacci lattice), coloured in squares.
namespace splatscope::kernels {

// Mean distance between neighbours.
inline double sphere_spacing(int points) {
  return std::sqrt(4 * std::numbers::pi / points);
}

inline std::vector<Surfel> sphere(int points) {
  std::vector<Surfel> surfels(static_cast<std::size_t>(points));
  const double radius = std::numbers::sqrt2 * sphere_spacing(points);  // to the diagonal neighbour
  for (int i = 0; i < points; ++i) {
    Surfel& surfel = surfels[static_cast<std::size_t>(i)];
    const double z = 1 - (2 * i + 1.0) / points, angle = 2 * std::numbers::pi * i / std::numbers::phi;
    const double ring = std::sqrt(1 - z * z);
    surfel.position = {ring * std::cos(angle), ring * std::sin(angle), z};
    const glm::dvec3 along{-std::sin(angle), std::cos(angle), 0};
    surfel.tangent_s = radius * along;
    surfel.tangent_t = radius * glm::cross(surfel.position, along);  // s x t is the outward normal
    surfel.color = {std::sin(11 * z) > 0 ? 0.9 : 0.2,
                    std::sin(9 * std::atan2(surfel.position.y, surfel.position.x)) > 0 ? 0.8 : 0.3, 0.5};
  }
  return surfels;
}

// Most of a square frame is the sphere.
inline View sphere_view(int size) {
  return look_at({2.2, 2.2, 5.3}, {0, 0, 0}, {0, 1, 0}, 19.5, size, size, 3, 9);
}

}  // namespace splatscope::kernels
