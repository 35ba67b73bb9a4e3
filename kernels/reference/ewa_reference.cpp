#include "kernels/reference/ewa_reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kernels/reference/ray_plane.h"
#include "model/stop.h"

namespace splatscope::kernels {
namespace {

// The part of a splat's weight at a pixel that may be there or not.
struct OpenWeight {
  std::size_t pixel = 0;
  double weight = 0;
  glm::dvec3 color{};
};

class Accumulator {
 public:
  Accumulator(const View& view, const ReferenceSettings& settings) : view_(view), settings_(settings) {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    picture_.width = view.width;
    picture_.height = view.height;
    picture_.sums.resize(pixels);
    certain_.resize(pixels);
  }

  void add(const Surfel& surfel) {
    const std::optional<SurfelFilter> filter = surfel_filter(view_, surfel, settings_.prefilter);
    if (!filter) {
      ++picture_.skipped;
      return;
    }
    const glm::dvec3 o = view_.camera_space(surfel.position);
    const glm::dvec3 s = view_.camera_direction(surfel.tangent_s);
    const glm::dvec3 t = view_.camera_direction(surfel.tangent_t);
    const glm::dvec3 a = filter->axes[0][0] * s + filter->axes[0][1] * t;  // p_c = o + y0 a + y1 b
    const glm::dvec3 b = filter->axes[1][0] * s + filter->axes[1][1] * t;
    const RayPlane plane(view_, o, a, b);
    const double reach = filter_reach(settings_);
    const PixelBox box = bounding_box(view_, o, reach * a, reach * b);
    const double height = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter->determinant);
    for (int row = box.top; row < box.bottom; ++row) {
      for (int column = box.left; column < box.right; ++column) {
        const RayHit hit = plane(column + 0.5, row + 0.5);
        if (!(hit.z >= view_.near_plane && hit.z <= view_.far_plane)) continue;
        add_at(row, column, hit.y, height, surfel.color);
      }
    }
  }

  ReferencePicture finish();

 private:
  void add_at(int row, int column, const glm::dvec2& y, double height, const glm::dvec3& color) {
    const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
                              static_cast<std::size_t>(column);
    const glm::dvec4 weighted(height * color, height);
    picture_.sums[pixel] += filter_value(settings_, y) * weighted;
    const FilterRange range = filter_range(settings_, y);
    certain_[pixel] += range.low * weighted;
    if (range.high > range.low) open_.push_back({pixel, height * (range.high - range.low), color});
  }

  const View& view_;
  const ReferenceSettings& settings_;
  ReferencePicture picture_;
  std::vector<glm::dvec4> certain_;  // sums at the low end of every range
  std::vector<OpenWeight> open_;
};

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

ReferencePicture Accumulator::finish() {
  const std::size_t pixels = picture_.sums.size();
  picture_.normalized.resize(pixels);
  picture_.lowest.resize(pixels);
  picture_.coverage.resize(pixels, Coverage::none);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    picture_.normalized[pixel] = normalized_color(picture_.sums[pixel]);
    picture_.lowest[pixel] = normalized_color(certain_[pixel]);
    if (certain_[pixel].w > 0) picture_.coverage[pixel] = Coverage::certain;
  }
  picture_.highest = picture_.lowest;
  std::stable_sort(open_.begin(), open_.end(),
                   [](const OpenWeight& a, const OpenWeight& b) { return a.pixel < b.pixel; });
  for (std::size_t first = 0, last = 0; first < open_.size(); first = last) {
    const std::size_t pixel = open_[first].pixel;
    while (last < open_.size() && open_[last].pixel == pixel) ++last;
    if (!(certain_[pixel].w > 0)) picture_.coverage[pixel] = Coverage::uncertain;
    bound_pixel(std::span(open_).subspan(first, last - first), certain_[pixel], picture_.lowest[pixel],
                picture_.highest[pixel]);
  }
  return std::move(picture_);
}

}  // namespace

ReferencePicture ewa_reference(const View& view, std::span<const Surfel> surfels,
                               const ReferenceSettings& settings) {
  Accumulator accumulator(view, settings);
  for (const Surfel& surfel : surfels) {
    stop_if_asked();
    accumulator.add(surfel);
  }
  return accumulator.finish();
}

}  // namespace splatscope::kernels
