#include "traces/neighbours.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <glm/geometric.hpp>

#include "traces/neighbour_search.h"

namespace splatscope::traces {
namespace {

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
  const NeighbourSearch search(surfels);
  NeighbourSearch::Found near;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    search.find(i, static_cast<std::size_t>(neighbours) + 1, near);
    surfels[i].radius = static_cast<float>(near.distance(near.size() - 1));
  }
}

void estimate_normals(std::span<Surfel> surfels, int neighbours, const glm::dvec3& eye) {
  const NeighbourSearch search(surfels);
  NeighbourSearch::Found near;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    search.find(i, static_cast<std::size_t>(neighbours) + 1, near);
    const glm::vec3 normal = normal_of(surfels, near);
    const bool faces_away = glm::dot(glm::dvec3(normal), eye - glm::dvec3(surfels[i].position)) < 0;
    surfels[i].normal = faces_away ? -normal : normal;
  }
}

double average_spacing(std::span<const Surfel> surfels) {
  constexpr std::size_t kLook = 4;  // itself, and room for a few on the same point
  const NeighbourSearch search(surfels);
  NeighbourSearch::Found near;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    search.find(i, kLook, near);
    for (std::size_t n = 0; n < near.size(); ++n) {
      if (near.distance(n) == 0) continue;
      sum += near.distance(n);
      ++count;
      break;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace splatscope::traces
