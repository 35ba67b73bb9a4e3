#include "traces/neighbours.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "model/stop.h"
#include "traces/neighbour_search.h"

namespace splatscope::traces {
namespace {

// Calls use(i, found) for every surfel i with its `count` nearest, from several threads at once.
template <class Use>
void for_each(std::span<const Surfel> surfels, std::size_t count, const Use& use) {
  const NeighbourSearch search(surfels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surfels.size(), 256), [&](const auto& range) {
    NeighbourSearch::Found found;
    stop_if_asked();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      search.find(i, count, found);
      use(i, found);
    }
  });
}

glm::vec3 normal_of(std::span<const Surfel> surfels, const NeighbourSearch::Found& near) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> points(3, static_cast<Eigen::Index>(near.size()));
  for (std::size_t n = 0; n < near.size(); ++n) {
    const glm::vec3& p = surfels[near.index[n]].position;
    points.col(static_cast<Eigen::Index>(n)) = Eigen::Vector3d(p.x, p.y, p.z);
  }
  points.colwise() -= points.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(points * points.transpose());
  const Eigen::Vector3d& spread = eigen.eigenvalues();  // ascending
  if (!(spread[1] > 1e-12 * spread[2])) return {};      // a line or a point has no normal
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  return {normal.x(), normal.y(), normal.z()};
}

}  // namespace

void estimate_radii(std::span<Surfel> surfels, int neighbours) {
  for_each(surfels, static_cast<std::size_t>(neighbours) + 1, [&](std::size_t i, const auto& found) {
    surfels[i].radius = static_cast<float>(found.distance(found.size() - 1));
  });
}

void estimate_normals(std::span<Surfel> surfels, int neighbours, const glm::dvec3& eye) {
  for_each(surfels, static_cast<std::size_t>(neighbours) + 1, [&](std::size_t i, const auto& found) {
    const glm::vec3 normal = normal_of(surfels, found);
    const bool faces_away = glm::dot(glm::dvec3(normal), eye - glm::dvec3(surfels[i].position)) < 0;
    surfels[i].normal = faces_away ? -normal : normal;
  });
}

double average_spacing(std::span<const Surfel> surfels) {
  constexpr std::size_t kLook = 4;  // itself, and room for a few on the same point
  std::vector<double> nearest(surfels.size(), 0.0);
  for_each(surfels, kLook, [&](std::size_t i, const auto& found) {
    for (std::size_t n = 0; n < found.size() && nearest[i] == 0; ++n) nearest[i] = found.distance(n);
  });
  double sum = 0;  // in this order: the same for any number of threads
  std::size_t count = 0;
  for (double distance : nearest) {
    sum += distance;
    count += distance > 0 ? 1 : 0;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace splatscope::traces
