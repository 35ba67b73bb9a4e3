#include "traces/models/mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

namespace splatscope::traces {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Mesh, WhatHasNoSurfaceIsLeftOutAndCounted) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {kNan, 0, 0}, {1e30f, 0, 0}};
  mesh.triangles = {{0, 1, 2},   // kept
                    {0, 1, 3},   // on one line
                    {1, 1, 2},   // a corner twice
                    {0, 1, 4},   // NaN
                    {0, 1, 5},   // too far out
                    {0, 1, 6},   // no such vertex
                    {2, 1, 3}};  // kept
  mesh.parts = {0, 1, 2, 3, 4, 5, 6};
  const MeshCounts counts = mend(mesh);
  EXPECT_EQ(counts.triangles, 2u);
  EXPECT_EQ(counts.triangles_degenerate, 2u);
  EXPECT_EQ(counts.triangles_not_finite, 2u);
  EXPECT_EQ(counts.triangles_out_of_range, 1u);
  EXPECT_EQ(mesh.parts, (std::vector<std::uint32_t>{0, 6}));
}

// A roof of two faces whose ridge is repeated for each of them, as OBJ readers do.
TEST(Mesh, MissingNormalsAreThoseOfTheFacesAround) {
  Mesh mesh;
  mesh.positions = {{-1, 0, 0}, {0, 1, 0}, {0, 1, -1}, {1, 0, 0}, {0, 1, -1}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.normals = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 7}, {kNan, 0, 0}, {0, 0, 0}};
  const MeshCounts counts = mend(mesh);
  EXPECT_EQ(counts.normals_computed, 5u);
  EXPECT_EQ(mesh.normals[3], glm::vec3(0, 0, 1)) << "given, but not of length 1";
  for (std::size_t ridge : {1u, 2u, 4u, 5u})
    EXPECT_LT(glm::distance(glm::abs(mesh.normals[ridge]), glm::vec3(0, 1, 0)), 1e-6) << ridge;
}

TEST(Mesh, APointHasTheAttributesOfTheCornersAroundIt) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}};
  mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}};
  mesh.parts = {5};
  const SurfacePoint point = surface_point(mesh, 0, {0.25, 0.25, 0.5});
  EXPECT_EQ(point.position, glm::vec3(1, 2, 0));
  EXPECT_EQ(point.normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(point.texcoord, glm::vec2(0.25, 0.5));
  EXPECT_EQ(point.color, glm::vec3(0.25, 0.25, 0.5));
  EXPECT_EQ(point.part, 5u);
  mesh.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 0}};  // they cancel: the face's
  EXPECT_EQ(surface_point(mesh, 0, {0.5, 0.5, 0}).normal, glm::vec3(0, 0, 1));
}

}  // namespace
}  // namespace splatscope::traces
