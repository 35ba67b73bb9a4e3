#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace splatscope::traces {

// Triangles, and what is known at their corners. Of normals, texcoords and colors each is empty or holds one
// entry a position.
struct Mesh {
  std::vector<glm::vec3> positions;  // object units
  std::vector<glm::vec3> normals;    // of any length; (0, 0, 0): unknown
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec3> colors;  // r g b, each in [0, 1]
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> parts;  // material or body part of each triangle; empty: all 0
};

// What was wrong with a mesh and was mended.
struct MeshCounts {
  std::size_t triangles = 0;               // kept
  std::size_t triangles_not_finite = 0;    // left out: a corner has a NaN or INF
  std::size_t triangles_out_of_range = 0;  // left out: a corner that does not exist
  std::size_t triangles_degenerate = 0;    // left out: no area
  std::size_t normals_computed = 0;        // vertices whose normal was missing: from the faces around them
  std::size_t textures_unreadable = 0;     // the material's colour stands in
  std::size_t materials_unreadable = 0;    // files of an OBJ file: light grey stands in
};

// A point on a mesh with the attributes of its triangle's corners, interpolated.
struct SurfacePoint {
  glm::vec3 position{};
  glm::vec3 normal{};  // of unit length
  glm::vec2 texcoord{};
  glm::vec3 color{1, 1, 1};
  std::uint32_t part = 0;
};

// What colours a surface: r g b, each in [0, 1].
using Paint = std::function<glm::vec3(const SurfacePoint&)>;

struct Model {
  Mesh mesh;
  Paint paint;
};

// The corners of each triangle side by side, for who looks at them again and again.
using TriangleCorners = std::vector<std::array<glm::vec3, 3>>;
TriangleCorners corners_of(const Mesh& mesh);

// Leaves out the triangles that have no surface and gives every vertex of the others a normal of unit length.
// Computed normals are weighted by area and smooth over vertices at the same position. Positions beyond
// 1e15 object units count as not finite: products of them would be.
MeshCounts mend(Mesh& mesh);

// `weights` are barycentric: those of the triangle's corners, their sum 1.
SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& weights);

}  // namespace splatscope::traces
