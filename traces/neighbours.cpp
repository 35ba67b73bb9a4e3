#include "traces/neighbours.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nanoflann.hpp>
#include <vector>

namespace splatscope::traces {
namespace {

// nanoflann's view of the surfels; its names are the library's.
struct Positions {
  std::span<const Surfel> surfels;
  std::size_t kdtree_get_point_count() const { return surfels.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return surfels[i].position[static_cast<glm::length_t>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// Distances in double: squares of float coordinates overflow.
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Positions, double>, Positions, 3>;

class Neighbours {
 public:
  explicit Neighbours(std::span<const Surfel> surfels) : positions_{surfels}, tree_(3, positions_) {}

  // Surfels nearest to number i, itself among them, nearest first; and their squared distances.
  std::size_t find(std::size_t i, std::size_t count) {
    index_.resize(count);
    squared_distance_.resize(count);
    const glm::vec3& p = positions_.surfels[i].position;
    const float query[] = {p.x, p.y, p.z};
    return tree_.knnSearch(query, count, index_.data(), squared_distance_.data());
  }

  std::uint32_t index(std::size_t i) const { return index_[i]; }
  double distance(std::size_t i) const { return std::sqrt(squared_distance_[i]); }

 private:
  Positions positions_;
  Tree tree_;
  std::vector<std::uint32_t> index_;
  std::vector<double> squared_distance_;
};

glm::vec3 normal_of(std::span<const Surfel> surfels, const Neighbours& near, std::size_t count) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> points(3, static_cast<Eigen::Index>(count));
  for (std::size_t n = 0; n < count; ++n) {
    const glm::vec3& p = surfels[near.index(n)].position;
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
  Neighbours near(surfels);
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const std::size_t found = near.find(i, static_cast<std::size_t>(neighbours) + 1);
    surfels[i].radius = static_cast<float>(near.distance(found - 1));
  }
}

void estimate_normals(std::span<Surfel> surfels, int neighbours, const glm::dvec3& eye) {
  Neighbours near(surfels);
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const std::size_t found = near.find(i, static_cast<std::size_t>(neighbours) + 1);
    const glm::vec3 normal = normal_of(surfels, near, found);
    const bool faces_away = glm::dot(glm::dvec3(normal), eye - glm::dvec3(surfels[i].position)) < 0;
    surfels[i].normal = faces_away ? -normal : normal;
  }
}

double average_spacing(std::span<const Surfel> surfels) {
  constexpr std::size_t kLook = 4;  // itself, and room for a few on the same point
  Neighbours near(surfels);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const std::size_t found = near.find(i, kLook);
    for (std::size_t n = 0; n < found; ++n) {
      if (near.distance(n) == 0) continue;
      sum += near.distance(n);
      ++count;
      break;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace splatscope::traces
