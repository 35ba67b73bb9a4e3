#include "traces/models/mesh.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

namespace splatscope::traces {
namespace {

constexpr float kLargest = 1e15f;

bool is_finite(const glm::vec3& p) {
  return std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest;
}

glm::dvec3 twice_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
  return glm::cross(b - a, c - a);
}

// Length 1, or false where the vector has no direction.
bool normalize(glm::vec3& v) {
  const double length = glm::length(glm::dvec3(v));
  if (!(length > 0 && std::isfinite(length))) return false;
  v = glm::vec3(glm::dvec3(v) / length);
  return true;
}

void leave_out_triangles(Mesh& mesh, MeshCounts& counts) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto t = mesh.triangles[i];
    const auto beyond = [&](std::uint32_t corner) { return corner >= mesh.positions.size(); };
    const auto broken = [&](std::uint32_t corner) { return !is_finite(mesh.positions[corner]); };
    if (std::ranges::any_of(t, beyond)) {
      ++counts.triangles_out_of_range;
    } else if (std::ranges::any_of(t, broken)) {
      ++counts.triangles_not_finite;
    } else if (!(glm::length(twice_area(mesh, t)) > 0)) {
      ++counts.triangles_degenerate;
    } else {
      mesh.triangles[kept] = t;
      if (!mesh.parts.empty()) mesh.parts[kept] = mesh.parts[i];
      ++kept;
    }
  }
  mesh.triangles.resize(kept);
  if (!mesh.parts.empty()) mesh.parts.resize(kept);
}

// For each vertex the first of those at the same position: files often repeat a vertex for each of its faces.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
  struct Placed {
    float x, y, z;
    std::uint32_t vertex;
    auto key() const { return std::tie(x, y, z, vertex); }
  };
  std::vector<Placed> placed;
  placed.reserve(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i)
    if (is_finite(positions[i])) placed.push_back({positions[i].x, positions[i].y, positions[i].z, i});
  tbb::parallel_sort(placed.begin(), placed.end(),
                     [](const Placed& a, const Placed& b) { return a.key() < b.key(); });
  std::vector<std::uint32_t> first(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) first[i] = i;
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Placed &a = placed[i - 1], &b = placed[i];
    if (a.x == b.x && a.y == b.y && a.z == b.z) first[b.vertex] = first[a.vertex];
  }
  return first;
}

void complete_normals(Mesh& mesh, MeshCounts& counts) {
  std::vector<char> used(mesh.positions.size(), 0), missing(mesh.positions.size(), 0);
  mesh.normals.resize(mesh.positions.size());
  for (const auto& t : mesh.triangles)
    for (std::uint32_t corner : t) used[corner] = 1;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (normalize(mesh.normals[i]) || used[i] == 0) continue;
    missing[i] = 1;
    ++counts.normals_computed;
  }
  if (counts.normals_computed == 0) return;
  const std::vector<std::uint32_t> first = weld(mesh.positions);
  std::vector<glm::dvec3> sum(mesh.positions.size());
  for (const auto& t : mesh.triangles)
    for (std::uint32_t corner : t) sum[first[corner]] += twice_area(mesh, t);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (missing[i] == 0) continue;
    const double length = glm::length(sum[first[i]]);  // 0: faces cancel; surface_point then takes the face's
    mesh.normals[i] = length > 0 ? glm::vec3(sum[first[i]] / length) : glm::vec3(0);
  }
}

template <class Value>
Value blend(const std::vector<Value>& values, const std::array<std::uint32_t, 3>& t, const glm::vec3& w) {
  return w.x * values[t[0]] + w.y * values[t[1]] + w.z * values[t[2]];
}

}  // namespace

MeshCounts mend(Mesh& mesh) {
  MeshCounts counts;
  leave_out_triangles(mesh, counts);
  counts.triangles = mesh.triangles.size();
  complete_normals(mesh, counts);
  return counts;
}

TriangleCorners corners_of(const Mesh& mesh) {
  TriangleCorners corners;
  corners.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    corners.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  return corners;
}

SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& weights) {
  const auto& t = mesh.triangles[triangle];
  const glm::vec3 w(weights);
  SurfacePoint point;
  point.position =
      glm::vec3(weights.x * glm::dvec3(mesh.positions[t[0]]) + weights.y * glm::dvec3(mesh.positions[t[1]]) +
                weights.z * glm::dvec3(mesh.positions[t[2]]));
  if (!mesh.normals.empty()) point.normal = blend(mesh.normals, t, w);
  if (!normalize(point.normal)) point.normal = glm::vec3(glm::normalize(twice_area(mesh, t)));
  if (!mesh.texcoords.empty()) point.texcoord = blend(mesh.texcoords, t, w);
  if (!mesh.colors.empty()) point.color = blend(mesh.colors, t, w);
  if (!mesh.parts.empty()) point.part = mesh.parts[triangle];
  return point;
}

}  // namespace splatscope::traces
