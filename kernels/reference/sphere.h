#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "kernels/reference/surfel_filter.h"
#include "kernels/sphere_points.h"
#include "kernels/view.h"

// For tests and benchmarks: a unit sphere of surfels spread evenly, coloured in squares.
namespace splatscope::kernels {

inline std::vector<Surfel> sphere(int points) {
  std::vector<Surfel> surfels(static_cast<std::size_t>(points));
  const double radius = std::numbers::sqrt2 * sphere_spacing(points);  // to the diagonal neighbour
  for (int i = 0; i < points; ++i) {
    Surfel& surfel = surfels[static_cast<std::size_t>(i)];
    const auto [place, along] = sphere_point(i, points);
    surfel.position = place;
    surfel.tangent_s = radius * along;
    surfel.tangent_t = radius * glm::cross(place, along);  // s x t is the outward normal
    surfel.color = {std::sin(11 * place.z) > 0 ? 0.9 : 0.2,
                    std::sin(9 * std::atan2(place.y, place.x)) > 0 ? 0.8 : 0.3, 0.5};
  }
  return surfels;
}

// Most of a square frame is the sphere.
inline View sphere_view(int size) {
  return look_at({2.2, 2.2, 5.3}, {0, 0, 0}, {0, 1, 0}, 19.5, size, size, 3, 9);
}

}  // namespace splatscope::kernels
