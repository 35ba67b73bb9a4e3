#include "ewa_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "kernels/object_space_ewa/alpha_texture.h"
#include "kernels/reference/ray_plane.h"
#include "studies/reference_comparison.h"

namespace splatscope::tests {
namespace {

using kernels::CutoffShape, kernels::ReferenceSettings, kernels::filter_reach;

// Of y beyond the parallelogram's edges; negative inside.
double distance_to_edge(const ReferenceSettings& filter, const glm::dvec2& y) {
  return std::max(std::abs(y.x), std::abs(y.y)) - filter_reach(filter);
}

// Of a coordinate of y at which filter_range may not be 0.
double largest_reach(const ReferenceSettings& filter, const Leave& leave) {
  return filter_reach(filter) + std::max(leave.cutoff_tolerance, leave.edge_tolerance);
}

FilterRange gaussian_range(const ReferenceSettings& filter, const Leave& leave, const glm::dvec2& y) {
  const bool circle = filter.shape == CutoffShape::circle;
  const double to_edge = distance_to_edge(filter, y);
  // Beyond the edge a texture gives its last texel, which lies inside the circle where they touch.
  const double r = filter_reach(filter);
  const double to_cutoff = circle ? glm::length(glm::clamp(y, -r, r)) - r : to_edge;
  const double edge_tolerance = circle ? leave.edge_tolerance : largest_reach(filter, leave) - r;
  const double cutoff_tolerance = circle ? leave.cutoff_tolerance : edge_tolerance;
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

TexelSpan texel_span(const ReferenceSettings& filter, const Leave& leave, double y) {
  const int length = leave.texture_length;
  const auto texel = [&](double coordinate) {
    const double index = std::floor(0.5 * (coordinate / filter_reach(filter) + 1.0) * length);
    return static_cast<int>(std::clamp(index, 0.0, length - 1.0));
  };
  const auto squared_centre = [&](int index) {
    const double centre = filter_reach(filter) * ((2.0 * index + 1.0) / length - 1.0);
    return centre * centre;
  };
  const int first = texel(y - leave.cutoff_tolerance);
  const int last = texel(y + leave.cutoff_tolerance);
  return {squared_centre(std::clamp(length / 2, first, last)),
          std::max(squared_centre(first), squared_centre(last))};
}

FilterRange texel_range(const ReferenceSettings& filter, const Leave& leave, const glm::dvec2& y) {
  const double to_edge = distance_to_edge(filter, y);
  if (to_edge > leave.edge_tolerance) return {};
  const TexelSpan column = texel_span(filter, leave, y.x);
  const TexelSpan row = texel_span(filter, leave, y.y);
  const auto value = [&](double squared_radius) {
    return kernels::alpha_texel(filter.cutoff, filter.shape, squared_radius) / 255.0;
  };
  return {to_edge <= -leave.edge_tolerance ? value(column.largest + row.largest) : 0.0,
          value(column.smallest + row.smallest)};
}

// The part of a splat's weight at a pixel that may be there or not.
struct OpenWeight {
  std::size_t pixel = 0;
  double weight = 0;
  glm::dvec3 color{};
};

// What splats add up to at the low end of their ranges, and what may come on top.
struct Ranges {
  std::vector<glm::dvec4> certain;
  std::vector<OpenWeight> open;
};

void add(const kernels::View& view, const kernels::Surfel& surfel, const ReferenceSettings& settings,
         const Leave& leave, Ranges& ranges) {
  const std::optional<kernels::SurfelFilter> filter =
      kernels::surfel_filter(view, surfel, settings.prefilter);
  if (!filter) return;
  const glm::dvec3 o = view.camera_space(surfel.position);
  const glm::dvec3 s = view.camera_direction(surfel.tangent_s);
  const glm::dvec3 t = view.camera_direction(surfel.tangent_t);
  const glm::dvec3 a = filter->axes[0][0] * s + filter->axes[0][1] * t;  // p_c = o + y0 a + y1 b
  const glm::dvec3 b = filter->axes[1][0] * s + filter->axes[1][1] * t;
  const kernels::RayPlane plane(view, o, a, b);
  const double reach = largest_reach(settings, leave);
  const kernels::PixelBox box = kernels::bounding_box(view, o, reach * a, reach * b);
  const double height = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter->determinant);
  for (int row = box.top; row < box.bottom; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      const kernels::RayHit hit = plane(column + 0.5, row + 0.5);
      if (!(hit.z >= view.near_plane && hit.z <= view.far_plane)) continue;
      const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
                                static_cast<std::size_t>(column);
      const FilterRange range = filter_range(settings, leave, hit.y);
      ranges.certain[pixel] += range.low * height * glm::dvec4(surfel.color, 1.0);
      if (range.high > range.low)
        ranges.open.push_back({pixel, height * (range.high - range.low), surfel.color});
    }
  }
}

// The smallest (sum + sum of w c)/(weight + sum of w) over every choice of weights w, each between 0 and its
// own, in one channel. The best choice is all of the values under the result, so taking them from the
// smallest up finds it.
double lowest_mean(double sum, double weight, std::vector<std::pair<double, double>>& value_and_weight) {
  std::sort(value_and_weight.begin(), value_and_weight.end());
  for (const auto& [value, open_weight] : value_and_weight) {
    if (weight > 0 && value * weight >= sum) break;
    sum += value * open_weight;
    weight += open_weight;
  }
  return sum / weight;
}

void bound_pixel(std::span<const OpenWeight> open, const glm::dvec4& certain, glm::dvec3& lowest,
                 glm::dvec3& highest) {
  std::vector<std::pair<double, double>> value_and_weight(open.size());
  for (int channel = 0; channel < 3; ++channel) {
    const auto values = [&](double sign) {
      std::transform(open.begin(), open.end(), value_and_weight.begin(), [&](const OpenWeight& part) {
        return std::pair(sign * part.color[channel], part.weight);
      });
    };
    values(1.0);
    lowest[channel] = lowest_mean(certain[channel], certain.w, value_and_weight);
    values(-1.0);
    highest[channel] = -lowest_mean(-certain[channel], certain.w, value_and_weight);
  }
}

EwaBounds bounds_of(Ranges ranges) {
  const std::vector<glm::dvec4>& certain = ranges.certain;
  EwaBounds bounds;
  for (const glm::dvec4& sums : certain) {
    bounds.lowest.push_back(kernels::normalized_color(sums));
    bounds.coverage.push_back(sums.w > 0 ? Coverage::certain : Coverage::none);
  }
  bounds.highest = bounds.lowest;
  std::vector<OpenWeight>& open = ranges.open;
  std::ranges::stable_sort(open, {}, &OpenWeight::pixel);
  for (std::size_t first = 0, last = 0; first < open.size(); first = last) {
    const std::size_t pixel = open[first].pixel;
    while (last < open.size() && open[last].pixel == pixel) ++last;
    if (!(certain[pixel].w > 0)) bounds.coverage[pixel] = Coverage::uncertain;
    bound_pixel(std::span(open).subspan(first, last - first), certain[pixel], bounds.lowest[pixel],
                bounds.highest[pixel]);
  }
  return bounds;
}

}  // namespace

FilterRange filter_range(const ReferenceSettings& filter, const Leave& leave, const glm::dvec2& y) {
  return leave.texture_length > 0 ? texel_range(filter, leave, y) : gaussian_range(filter, leave, y);
}

EwaBounds ewa_bounds(const kernels::View& view, std::span<const kernels::Surfel> surfels,
                     const ReferenceSettings& filter, const Leave& leave) {
  Ranges ranges;
  ranges.certain.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  for (const kernels::Surfel& surfel : surfels) add(view, surfel, filter, leave, ranges);
  return bounds_of(std::move(ranges));
}

SurfaceAgreement agreement(const Frame& frame, const kernels::SplatSums& reference, const EwaBounds& bounds) {
  const double half = 0.5 * studies::median_weight(reference);
  SurfaceAgreement both;
  for (std::size_t pixel = 0; pixel < bounds.coverage.size(); ++pixel) {
    if (bounds.coverage[pixel] != Coverage::certain) continue;
    Agreement& out = reference.sums[pixel].w < half ? both.fringe : both.surface;
    ++out.pixels;
    const Vec4 color = frame.color(pixel);
    double distance = 0;  // 1/255
    for (int c = 0; c < 3; ++c) {
      const double value = color[static_cast<std::size_t>(c)];
      distance = std::max(
          {distance, 255 * (bounds.lowest[pixel][c] - value), 255 * (value - bounds.highest[pixel][c])});
    }
    out.outside += distance > 0.5;
    out.worst = std::max(out.worst, distance);
  }
  return both;
}

}  // namespace splatscope::tests
