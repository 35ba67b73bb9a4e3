#include "kernels/reference/filter_value.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace splatscope::kernels {
namespace {

double radius(const ReferenceSettings& settings) {
  return std::sqrt(2.0 * settings.cutoff);
}

// Of y beyond the parallelogram's edges; negative inside.
double distance_to_edge(const ReferenceSettings& settings, const glm::dvec2& y) {
  return std::max(std::abs(y.x), std::abs(y.y)) - radius(settings);
}

FilterRange gaussian_range(const ReferenceSettings& settings, const glm::dvec2& y) {
  const bool circle = settings.shape == CutoffShape::circle;
  const double to_edge = distance_to_edge(settings, y);
  // Beyond the edge a texture gives its last texel, which lies inside the circle where they touch.
  const double r = radius(settings);
  const double to_cutoff = circle ? glm::length(glm::clamp(y, -r, r)) - r : to_edge;
  const double edge_tolerance = circle ? settings.edge_tolerance : filter_reach(settings) - r;
  const double cutoff_tolerance = circle ? settings.cutoff_tolerance : edge_tolerance;
  if (to_cutoff > cutoff_tolerance || to_edge > edge_tolerance) return {};
  const double value = std::exp(-0.5 * glm::dot(y, y));
  const bool certain = to_cutoff <= -cutoff_tolerance && to_edge <= -edge_tolerance;
  return {certain ? value : 0.0, value};
}

// Squared coordinates of the centres of the texels that may be the nearest to y, the last texel beyond the
// edge.
struct TexelSpan {
  double smallest = 0;
  double largest = 0;
};

TexelSpan texel_span(const ReferenceSettings& settings, double y) {
  const int length = settings.texture_length;
  const auto texel = [&](double coordinate) {
    const double index = std::floor(0.5 * (coordinate / radius(settings) + 1.0) * length);
    return static_cast<int>(std::clamp(index, 0.0, length - 1.0));
  };
  const auto squared_centre = [&](int index) {
    const double centre = radius(settings) * ((2.0 * index + 1.0) / length - 1.0);
    return centre * centre;
  };
  const int first = texel(y - settings.cutoff_tolerance);
  const int last = texel(y + settings.cutoff_tolerance);
  return {squared_centre(std::clamp(length / 2, first, last)),
          std::max(squared_centre(first), squared_centre(last))};
}

FilterRange texel_range(const ReferenceSettings& settings, const glm::dvec2& y) {
  const double to_edge = distance_to_edge(settings, y);
  if (to_edge > settings.edge_tolerance) return {};
  const TexelSpan column = texel_span(settings, y.x);
  const TexelSpan row = texel_span(settings, y.y);
  const auto value = [&](double squared_radius) {
    return alpha_texel(settings.cutoff, settings.shape, squared_radius) / 255.0;
  };
  return {to_edge <= -settings.edge_tolerance ? value(column.largest + row.largest) : 0.0,
          value(column.smallest + row.smallest)};
}

}  // namespace

double filter_value(const ReferenceSettings& settings, const glm::dvec2& y) {
  const double distance = settings.shape == CutoffShape::circle ? glm::length(y) - radius(settings)
                                                                : distance_to_edge(settings, y);
  return distance <= 0 ? std::exp(-0.5 * glm::dot(y, y)) : 0.0;
}

FilterRange filter_range(const ReferenceSettings& settings, const glm::dvec2& y) {
  return settings.texture_length > 0 ? texel_range(settings, y) : gaussian_range(settings, y);
}

double filter_reach(const ReferenceSettings& settings) {
  return radius(settings) + std::max(settings.cutoff_tolerance, settings.edge_tolerance);
}

}  // namespace splatscope::kernels
