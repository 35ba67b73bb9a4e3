#include "traces/gamma.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "model/stop.h"
#include "traces/neighbour_search.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kAsked = 10000;  // places
constexpr double kShare = 0.99;        // of the places whose sums do not saturate

// r_j of Ren 2002, Eq. 1: in the plane of surfel j, in units of its radius.
class Filter {
 public:
  Filter(const Surfel& surfel, const Splatting& splatting)
      : centre_(surfel.position),
        peak_(0.5 * std::numbers::inv_pi / (splatting.sigma * splatting.sigma)),
        cut_(2 * splatting.cutoff),
        circular_(splatting.circular_cutoff) {
    const auto [s, t] = tangents(surfel);  // of length h
    const double scale = 1 / (splatting.sigma * double{surfel.radius} * double{surfel.radius});
    s_ = glm::dvec3(s) * scale;
    t_ = glm::dvec3(t) * scale;
  }

  double at(const glm::dvec3& point) const {
    const glm::dvec3 to = point - centre_;
    const double y0 = glm::dot(to, s_), y1 = glm::dot(to, t_);
    const double squared = y0 * y0 + y1 * y1;
    const double cut = circular_ ? squared : std::max(y0 * y0, y1 * y1);
    return cut > cut_ ? 0 : peak_ * std::exp(-0.5 * squared);
  }

 private:
  glm::dvec3 centre_, s_{}, t_{};
  double peak_, cut_;
  bool circular_;
};

// Whether a view along the normal of `asked` shows both surfels in its pixel: neither lies more than z_t
// behind the other's plane there (Ren 2002, 5.1), and both face the eye.
bool shown_together(const Surfel& surfel, const Surfel& asked, double depth_offset) {
  const glm::dvec3 normal(surfel.normal);
  const double facing = glm::dot(normal, glm::dvec3(asked.normal));
  const double apart = glm::dot(glm::dvec3(surfel.position) - glm::dvec3(asked.position), normal);
  return facing > 0 && std::abs(apart) <= depth_offset * facing;
}

// The furthest from its centre that a splat adds to a surfel shown with it: in its plane as far as the filter
// goes, across it z_t.
double reach_of(const Surfel& surfel, const Splatting& splatting) {
  constexpr double kRounding = 1.00001;  // of binary32, in which distances are found
  const double shape = splatting.circular_cutoff ? 1 : std::numbers::sqrt2;
  const double filter = shape * std::sqrt(2 * splatting.cutoff) * splatting.sigma * double{surfel.radius};
  return kRounding * std::hypot(filter, splatting.depth_offset);
}

// A place about every `step`th surfel, in its plane and within half its radius: all of the surface between
// surfels of a grid, whose radius is twice as far as its middles lie. Spread evenly (Roberts's R2).
std::vector<Surfel> places_about(std::span<const Surfel> surfels, std::size_t step) {
  std::vector<Surfel> places;
  for (std::size_t i = 0; i < surfels.size(); i += step) {
    const auto number = static_cast<double>(places.size());
    const double angle = 2 * std::numbers::pi * glm::fract(0.7548776662466927 * number);
    const double radius = 0.5 * std::sqrt(glm::fract(0.5698402909980532 * number));
    const auto [s, t] = tangents(surfels[i]);
    places.push_back(surfels[i]);
    places.back().position += glm::vec3(radius * (std::cos(angle) * s + std::sin(angle) * t));
  }
  return places;
}

}  // namespace

// Each surfel adds its filter to the places that it reaches: so that none is missed, however small the
// surfels are that lie between.
std::vector<double> filter_sums(std::span<const Surfel> surfels, const Splatting& splatting,
                                std::span<const Surfel> asked) {
  const NeighbourSearch search(asked);
  constexpr std::size_t kParts = 16;  // each with sums of its own: the same for any number of threads
  using Range = tbb::blocked_range<std::size_t>;
  const auto add = [&](const Range& range, std::vector<double> sums) {
    for (std::size_t j = range.begin(); j < range.end(); ++j) {
      const Surfel& surfel = surfels[j];
      const Filter filter(surfel, splatting);
      search.within(surfel.position, reach_of(surfel, splatting), [&](std::uint32_t i) {
        stop_if_asked();
        if (shown_together(surfel, asked[i], splatting.depth_offset)) sums[i] += filter.at(asked[i].position);
      });
    }
    return sums;
  };
  const auto both = [](std::vector<double> sums, const std::vector<double>& others) {
    std::ranges::transform(sums, others, sums.begin(), std::plus());
    return sums;
  };
  return tbb::parallel_deterministic_reduce(Range(0, surfels.size(), surfels.size() / kParts + 1),
                                            std::vector<double>(asked.size()), add, both);
}

double suitable_gamma(std::span<const Surfel> surfels, const Splatting& splatting) {
  if (surfels.empty()) return kPaperGamma;
  const std::vector<Surfel> places = places_about(surfels, (surfels.size() + kAsked - 1) / kAsked);
  std::vector<double> sums = filter_sums(surfels, splatting, places);
  const auto high =
      sums.begin() + static_cast<std::ptrdiff_t>(std::ceil(kShare * static_cast<double>(sums.size()))) - 1;
  std::ranges::nth_element(sums, high);
  return std::min(kPaperGamma, 1 / *high);
}

}  // namespace splatscope::traces
