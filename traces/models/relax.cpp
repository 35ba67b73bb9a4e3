#include "traces/models/relax.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>

#include "model/stop.h"
#include "traces/neighbour_search.h"

namespace splatscope::traces {
namespace {

constexpr std::size_t kNeighbours = 12;  // looked at
constexpr std::size_t kReach = 8;        // the neighbour at 1/1.2 of the distance up to which points push
constexpr double kWider = 1.2;
constexpr double kStep = 0.3;      // of a push, in units of that distance
constexpr double kFurthest = 0.2;  // that a point moves in a round, in the same units

glm::dvec3 normal_of(const TriangleCorners& mesh, std::uint32_t triangle) {
  const Triangle t = triangle_of(mesh, triangle);
  return glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
}

// A point with what it looks at. Points move so little that their neighbours stay the same.
struct Surroundings {
  std::array<std::uint32_t, kNeighbours> near{};
  std::size_t count = 0;
  double reach = 0;  // up to where points push
};

Surroundings look_around(std::span<const Surfel> points, std::size_t i, const NeighbourSearch& search,
                         NeighbourSearch::Found& found) {
  Surroundings around;
  search.find(i, kNeighbours + 1, found);  // itself among them
  around.reach = kWider * found.distance(std::min(kReach, found.size() - 1));
  const glm::dvec3 normal(points[i].normal);
  for (const std::uint32_t j : found.index) {
    if (j == i || around.count == kNeighbours || glm::dot(glm::dvec3(points[j].normal), normal) < 0) continue;
    around.near[around.count++] = j;
  }
  return around;
}

// Where the points around push number i, within its tangent plane.
glm::dvec3 pushed(std::span<const Surfel> points, std::size_t i, const Surroundings& around) {
  const glm::dvec3 position(points[i].position), normal(points[i].normal);
  glm::dvec3 push(0);
  for (std::size_t n = 0; n < around.count; ++n) {
    const glm::dvec3 from = position - glm::dvec3(points[around.near[n]].position);
    const double distance = glm::length(from);
    if (!(distance > 0 && distance < around.reach)) continue;
    const double nearness = 1 - distance / around.reach;
    push += nearness * nearness / distance * from;
  }
  push = kStep * around.reach * (push - glm::dot(push, normal) * normal);
  const double length = glm::length(push), furthest = kFurthest * around.reach;
  return position + (length > furthest ? furthest / length : 1) * push;
}

}  // namespace

void relax(const TriangleCorners& mesh, const Voxels& voxels, const VoxelIndex& index, int rounds,
           std::vector<MeshSample>& points) {
  const auto for_each = [&](const auto& use) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
      NeighbourSearch::Found found;
      stop_if_asked();
      for (std::size_t i = range.begin(); i < range.end(); ++i) use(i, found);
    });
  };
  std::vector<Surfel> before(points.size());  // the search knows surfels
  std::vector<Surroundings> around(points.size());
  for (int round = 0; round < rounds; ++round) {
    for_each([&](std::size_t i, auto&) {
      before[i].position = points[i].position;
      before[i].normal = normal_of(mesh, points[i].triangle);
    });
    if (round == 0) {
      const NeighbourSearch search(before);
      for_each([&](std::size_t i, auto& found) { around[i] = look_around(before, i, search, found); });
    }
    for_each([&](std::size_t i, auto&) {
      const glm::dvec3 to = pushed(before, i, around[i]);
      const std::uint32_t cell = index.at(glm::uvec3(glm::max((to - voxels.low) / voxels.size, 0.0)));
      if (cell != VoxelIndex::kNone) points[i] = closest_sample(mesh, voxels.triangles_of(cell), to);
    });
  }
}

}  // namespace splatscope::traces
