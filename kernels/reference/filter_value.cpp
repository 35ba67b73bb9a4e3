#include "kernels/reference/filter_value.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace splatscope::kernels {

double filter_reach(const ReferenceSettings& settings) {
  return std::sqrt(2.0 * settings.cutoff);
}

double filter_value(const ReferenceSettings& settings, const glm::dvec2& y) {
  const double distance =
      settings.shape == CutoffShape::circle ? glm::length(y) : std::max(std::abs(y.x), std::abs(y.y));
  return distance <= filter_reach(settings) ? std::exp(-0.5 * glm::dot(y, y)) : 0.0;
}

}  // namespace splatscope::kernels
