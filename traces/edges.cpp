#include "traces/edges.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "model/stop.h"
#include "traces/neighbour_search.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kNeighbours = 16;
constexpr double kWidestGap = 0.75 * std::numbers::pi;  // inside

// The widest angle of the tangent plane in which none of the surfels `near` lies.
double widest_gap(std::span<const Surfel> surfels, const Surfel& surfel,
                  std::span<const std::uint32_t> near) {
  const Tangents axes = tangents(surfel);
  std::array<double, kNeighbours + 1> angles;
  std::size_t count = 0;
  for (const std::uint32_t i : near) {
    if (glm::dot(surfels[i].normal, surfel.normal) < 0) continue;
    const glm::dvec3 to = glm::dvec3(surfels[i].position) - glm::dvec3(surfel.position);
    const double x = glm::dot(to, axes.s), y = glm::dot(to, axes.t);
    if (x != 0 || y != 0) angles[count++] = std::atan2(y, x);  // not the surfel itself
  }
  if (count == 0) return 2 * std::numbers::pi;
  std::sort(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(count));
  double widest = angles[0] + 2 * std::numbers::pi - angles[count - 1];
  for (std::size_t i = 1; i < count; ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  return widest;
}

}  // namespace

std::vector<char> at_edge(std::span<const Surfel> surfels) {
  const NeighbourSearch search(surfels);
  std::vector<char> edge(surfels.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surfels.size()), [&](const auto& range) {
    NeighbourSearch::Found near;
    stop_if_asked();
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      search.find(k, kNeighbours + 1, near);  // itself among them
      edge[k] = widest_gap(surfels, surfels[k], near.index) >= kWidestGap;
    }
  });
  return edge;
}

}  // namespace splatscope::traces
