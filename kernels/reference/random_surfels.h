#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "kernels/reference/surfel_filter.h"

namespace splatscope::kernels {

// For tests: surfels in every direction within 1.5 of the origin, of size 0.05 to 0.25.
inline std::vector<Surfel> random_surfels(int count, std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return glm::dvec3(uniform(generator), uniform(generator), uniform(generator)); };
  std::vector<Surfel> surfels(static_cast<std::size_t>(count));
  for (Surfel& surfel : surfels) {
    surfel.position = 1.5 * vector();
    const glm::dvec3 normal = glm::normalize(vector());
    const glm::dvec3 s = glm::normalize(glm::cross(normal, vector()));
    const double h = 0.15 + 0.1 * uniform(generator);
    surfel.tangent_s = h * s;
    surfel.tangent_t = h * glm::cross(normal, s);
    surfel.sigma = 0.8 + 0.4 * uniform(generator);
    surfel.weight = 1.0 + 0.5 * uniform(generator);
    surfel.color = 0.5 + 0.5 * vector();
  }
  return surfels;
}

}  // namespace splatscope::kernels
