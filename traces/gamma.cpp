#include "traces/gamma.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "model/stop.h"
#include "traces/neighbour_search.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kAsked = 10000;  // surfels
// Of more splats over a surfel each would be worth less than half a step of 8 bits.
constexpr std::size_t kMostNeighbours = 1024;
// The largest sum between the surfels of a square grid is 1.355, that at them 1.275: 1.063 times as much. A
// little is left to grids that are not square.
constexpr double kBetween = 1.07;
constexpr double kShare = 0.99;  // of the surfels whose sums do not saturate

// r_j of Ren 2002, Eq. 1, at a point: in the plane of surfel j, in units of its radius.
double filter_at(const Surfel& surfel, const Splatting& splatting, const glm::dvec3& point) {
  const glm::dvec3 to = point - glm::dvec3(surfel.position);
  const auto [s, t] = tangents(surfel);  // of length h
  const double scale = 1 / (splatting.sigma * double{surfel.radius} * double{surfel.radius});
  const double y0 = glm::dot(to, s) * scale, y1 = glm::dot(to, t) * scale;
  const double squared = y0 * y0 + y1 * y1;
  const double cut = splatting.circular_cutoff ? squared : std::max(y0 * y0, y1 * y1);
  if (cut > 2 * splatting.cutoff) return 0;
  return 0.5 * std::numbers::inv_pi / (splatting.sigma * splatting.sigma) * std::exp(-0.5 * squared);
}

// Whether a view along the normal of `asked` shows both surfels in its pixel: neither lies more than z_t
// behind the other's plane there (Ren 2002, 5.1), and both face the eye.
bool shown_together(const Surfel& surfel, const Surfel& asked, double depth_offset) {
  const glm::dvec3 normal(surfel.normal);
  const double facing = glm::dot(normal, glm::dvec3(asked.normal));
  const double apart = glm::dot(glm::dvec3(surfel.position) - glm::dvec3(asked.position), normal);
  return facing > 0 && std::abs(apart) <= depth_offset * facing;
}

// The surfels whose splats may reach surfel i: as many of the nearest as it takes for the furthest to lie
// beyond the reach of the largest.
void find_reaching(const NeighbourSearch& search, std::span<const Surfel> surfels, const Splatting& splatting,
                   std::size_t i, NeighbourSearch::Found& near) {
  const double shape = splatting.circular_cutoff ? 1 : std::numbers::sqrt2;
  const double reach = shape * std::sqrt(2 * splatting.cutoff) * splatting.sigma;  // in radii
  for (std::size_t count = 64; count <= kMostNeighbours; count *= 2) {
    search.find(i, count, near);
    float largest = 0;
    for (const std::uint32_t j : near.index) largest = std::max(largest, surfels[j].radius);
    if (near.size() < count || near.distance(count - 1) > reach * largest) return;
  }
}

}  // namespace

std::vector<double> filter_sums(std::span<const Surfel> surfels, const Splatting& splatting,
                                std::size_t step) {
  const NeighbourSearch search(surfels);
  std::vector<double> sums((surfels.size() + step - 1) / step);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sums.size(), 256), [&](const auto& range) {
    NeighbourSearch::Found near;
    stop_if_asked();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Surfel& asked = surfels[i * step];
      find_reaching(search, surfels, splatting, i * step, near);
      for (const std::uint32_t j : near.index) {
        if (shown_together(surfels[j], asked, splatting.depth_offset))
          sums[i] += filter_at(surfels[j], splatting, asked.position);
      }
    }
  });
  return sums;
}

double suitable_gamma(std::span<const Surfel> surfels, const Splatting& splatting) {
  if (surfels.empty()) return kPaperGamma;
  std::vector<double> sums = filter_sums(surfels, splatting, surfels.size() / kAsked + 1);
  const auto high = sums.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(sums.size() - 1));
  std::ranges::nth_element(sums, high);
  return std::min(kPaperGamma, 1 / (kBetween * *high));
}

}  // namespace splatscope::traces
