#include "traces/models/sampler.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <utility>

#include "traces/models/parametric.h"
#include "traces/models/triangle.h"
#include "traces/models/voxels.h"

namespace splatscope::traces {
namespace {

Mesh ball(int cells) {
  Mesh mesh = sphere(cells, [](const glm::dvec3&) { return 1.0; });
  mend(mesh);
  return mesh;
}

std::vector<MeshSample> sample_count(const Mesh& mesh, std::size_t count) {
  SamplerOptions options;
  options.count = count;
  return sample(mesh, options).points;
}

TEST(Sampler, GivesExactlyAsManyPointsAsAskedForOnTheSurface) {
  const Mesh mesh = ball(8);
  const TriangleCorners corners = corners_of(mesh);
  for (std::size_t count : {0u, 1u, 2u, 3u, 7u, 100u, 767u, 768u, 5000u}) {
    const auto samples = sample_count(mesh, count);
    ASSERT_EQ(samples.size(), count);
    for (const MeshSample& s : samples) {
      ASSERT_LT(s.triangle, mesh.triangles.size());
      const glm::dvec3 p = point_at(triangle_of(corners, s.triangle), s.weights);
      ASSERT_LT(glm::distance(p, glm::dvec3(s.position)), 1e-6);
      ASSERT_GE(std::min({s.weights.x, s.weights.y, s.weights.z}), -1e-12);
    }
  }
}

std::size_t distinct_positions(const std::vector<MeshSample>& points) {
  std::set<std::array<float, 3>> positions;
  for (const MeshSample& p : points) positions.insert({p.position.x, p.position.y, p.position.z});
  return positions.size();
}

Mesh triangle_at(float x, float y, float edge) {
  Mesh mesh;
  mesh.positions = {{x, y, x}, {x + edge, y, x}, {x, y + edge, x}};
  mesh.triangles = {{0, 1, 2}};
  mend(mesh);
  return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

// Tiny triangles that hang together nowhere.
Mesh crumbs(int edge) {
  Mesh mesh;
  for (int i = 0; i < edge * edge; ++i)
    append(mesh, triangle_at(static_cast<float>(i % edge), static_cast<float>(i / edge), 0.002f));
  return mesh;
}

// Points meet in the corners of meshes with borders.
TEST(Sampler, NoTwoPointsHaveTheSamePosition) {
  Mesh square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  mend(square);
  for (const auto& [mesh, count] : {std::pair(square, 100000u), std::pair(crumbs(40), 60000u)}) {
    SamplerOptions options;
    options.count = count;
    const MeshSamples samples = sample(mesh, options);
    EXPECT_TRUE(samples.copy_of.empty());
    EXPECT_EQ(distinct_positions(samples.points), count) << mesh.triangles.size() << " triangles";
  }
}

// Two triangles so far apart that each lies in a cell or two; the second has 66 places, near 1e7.
TEST(Sampler, PartsFarApartHavePlacesOfTheirOwn) {
  Mesh mesh = triangle_at(0, 0, 1);
  append(mesh, triangle_at(1e7f, 0, 10));
  SamplerOptions options;
  options.count = 5000;
  const MeshSamples samples = sample(mesh, options);
  EXPECT_TRUE(samples.copy_of.empty()) << samples.copy_of.size();
  EXPECT_EQ(distinct_positions(samples.points), 5000u);
}

// Near 1000 binary32 has steps of 6e-5: the triangle has 45 places, and takes them all.
TEST(Sampler, WhatHasNoPlaceOfItsOwnIsACopy) {
  const Mesh mesh = triangle_at(1000, 1000, 0.0005f);
  SamplerOptions options;
  for (std::size_t count : {40u, 45u, 46u, 1000u}) {
    options.count = count;
    const MeshSamples samples = sample(mesh, options);
    ASSERT_EQ(samples.points.size(), count);
    EXPECT_EQ(samples.distinct(), std::min<std::size_t>(count, 45));
    EXPECT_EQ(distinct_positions(samples.points), samples.distinct());
    for (std::size_t i = 0; i < samples.copy_of.size(); ++i) {
      const MeshSample &copy = samples.points[samples.distinct() + i],
                       &of = samples.points[samples.copy_of[i]];
      ASSERT_LT(samples.copy_of[i], samples.distinct());
      ASSERT_EQ(copy.position, of.position);
      ASSERT_EQ(copy.triangle, of.triangle);
      ASSERT_EQ(copy.weights, of.weights);
    }
  }
}

// Far more points than the tree can have cells, and than there are places tried at first.
TEST(Sampler, GoesOnWhereTheTreeIsCutShort) {
  const Mesh mesh = ball(8);
  SamplerOptions options;
  options.count = 1000;
  options.depth = 3;
  EXPECT_EQ(sample(mesh, options).points.size(), 1000u);
}

TEST(Sampler, DoesNotDependOnTheNumberOfThreads) {
  const Mesh mesh = ball(32);
  const auto many = sample_count(mesh, 4000);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = sample_count(mesh, 4000);
  ASSERT_EQ(many.size(), single.size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    ASSERT_EQ(many[i].position, single[i].position);
    ASSERT_EQ(many[i].triangle, single[i].triangle);
  }
}

// Splatting wants no holes and no clusters: every place of the sphere has a point nearby, and few points lie
// much closer together than the average.
TEST(Sampler, SpreadsPointsEvenly) {
  constexpr std::size_t kCount = 4000;
  for (int cells : {3, 64}) {  // few large triangles, many small ones
    const auto samples = sample_count(ball(cells), kCount);
    const double spacing = std::sqrt(4 * 3.14159265358979 / kCount);  // of a square grid
    std::size_t close = 0;
    double furthest_neighbour = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      double nearest = 4;
      for (std::size_t j = 0; j < kCount; ++j)
        if (i != j)
          nearest = std::min(nearest,
                             glm::distance(glm::dvec3(samples[i].position), glm::dvec3(samples[j].position)));
      close += nearest < 0.3 * spacing ? 1 : 0;
      furthest_neighbour = std::max(furthest_neighbour, nearest);
    }
    EXPECT_LT(close, kCount / 20) << cells;
    EXPECT_LT(furthest_neighbour, 1.8 * spacing) << cells;
    const Mesh probes = ball(24);
    for (const glm::vec3& probe : probes.positions) {
      double nearest = 4;
      for (const MeshSample& s : samples)
        nearest = std::min(nearest, glm::distance(glm::normalize(glm::dvec3(s.position)), glm::dvec3(probe)));
      ASSERT_LT(nearest, 1.6 * spacing) << cells << ": a hole";
    }
  }
}

// A sheet whose left half is two triangles and whose right half is 2 cells x cells.
Mesh half_finely_cut(int cells) {
  Mesh mesh;
  mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto row = static_cast<unsigned>(cells) + 1;
  for (unsigned y = 0; y < row; ++y)
    for (unsigned x = 0; x < row; ++x)
      mesh.positions.emplace_back(static_cast<float>(x) / static_cast<float>(cells),
                                  static_cast<float>(y) / static_cast<float>(cells), 0);
  for (unsigned y = 0; y + 1 < row; ++y) {
    for (unsigned x = 0; x + 1 < row; ++x) {
      const unsigned at = 4 + y * row + x;
      mesh.triangles.push_back({at, at + 1, at + row + 1});
      mesh.triangles.push_back({at, at + row + 1, at + row});
    }
  }
  mend(mesh);
  return mesh;
}

// No tenth of the sheet has fewer points than four fifths of what its area asks for: a cell has one before
// any has two, and there are nearly as many cells as points.
TEST(Sampler, FinelyCutPlacesTakeNoPointsFromCoarseOnes) {
  constexpr std::size_t kCount = 5000, kTenths = 10;
  const auto samples = sample_count(half_finely_cut(100), kCount);
  std::array<std::size_t, kTenths> points{};
  for (const MeshSample& s : samples)
    ++points.at(std::min(kTenths - 1, static_cast<std::size_t>((s.position.x + 1) * kTenths / 2)));
  for (const std::size_t tenth : points) EXPECT_GT(tenth, kCount / kTenths * 4 / 5);
}

// How unevenly splats add up: the sums, at the points, of Gaussians as wide as half the distance to the
// eighth neighbour of their centre; their standard deviation in units of the mean.
double unevenness(const std::vector<MeshSample>& samples) {
  const std::size_t count = samples.size();
  std::vector<double> sums(count), squared(count);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 to = glm::dvec3(samples[i].position) - glm::dvec3(samples[k].position);
      squared[i] = glm::dot(to, to);
    }
    std::vector<double> sorted = squared;
    std::nth_element(sorted.begin(), sorted.begin() + 8, sorted.end());
    for (std::size_t i = 0; i < count; ++i) sums[i] += std::exp(-0.5 * squared[i] / (0.25 * sorted[8]));
  }
  double sum = 0, squares = 0;
  for (const double at : sums) {
    sum += at;
    squares += at * at;
  }
  const double mean = sum / static_cast<double>(count);
  return std::sqrt(squares / static_cast<double>(count) - mean * mean) / mean;
}

TEST(Sampler, RelaxationEvensTheSumsOfSplats) {
  for (int cells : {3, 64}) {
    const Mesh mesh = ball(cells);
    SamplerOptions options;
    options.count = 3000;
    const double relaxed = unevenness(sample(mesh, options).points);
    options.relaxations = 0;
    const double before = unevenness(sample(mesh, options).points);
    EXPECT_LT(relaxed, 0.5 * before) << cells << " cells; before: " << before;
  }
}

TEST(Sampler, PriorityAndDistributionCanBeReplaced) {
  const Mesh mesh = ball(16);
  SamplerOptions options;
  options.count = 500;
  options.priority = [](const SampledCell& cell) { return cell.center.y > 0 ? 1.0 : 0.0; };
  for (const MeshSample& s : sample(mesh, options).points) EXPECT_GT(s.position.y, -0.3f);
  options.priority = unsampled_triangles;
  options.depth = 0;  // one cell, the whole ball: every place is projected from its corner
  options.count = 1;
  options.distribution = [](const SampledCell&, std::size_t) { return glm::dvec3(1, 1, 1); };
  const auto corner = sample(mesh, options).points;
  EXPECT_GT(glm::dot(glm::dvec3(corner[0].position), glm::normalize(glm::dvec3(1, 1, 1))), 0.98);
}

}  // namespace
}  // namespace splatscope::traces
