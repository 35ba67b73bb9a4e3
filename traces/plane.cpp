#include "traces/plane.h"

#include <cmath>

namespace splatscope::traces {

std::vector<Surfel> make_plane(const SurfelSource& source) {
  const double radius = std::sqrt(2.0) * kPlaneSpacing;
  std::vector<Surfel> surfels;
  surfels.reserve(static_cast<std::size_t>(source.rows) * static_cast<std::size_t>(source.columns));
  for (int row = 0; row < source.rows; ++row) {
    for (int column = 0; column < source.columns; ++column) {
      const bool light = (row / source.checker_square + column / source.checker_square) % 2 == 0;
      Surfel surfel;
      surfel.position = {kPlaneSpacing * (column - 0.5 * (source.columns - 1)), 0,
                         kPlaneSpacing * (row - 0.5 * (source.rows - 1))};
      surfel.normal = {0, 1, 0};
      surfel.radius = static_cast<float>(radius);
      surfel.color = glm::vec3(light ? source.checker_light : source.checker_dark);
      surfels.push_back(surfel);
    }
  }
  return surfels;
}

}  // namespace splatscope::traces
