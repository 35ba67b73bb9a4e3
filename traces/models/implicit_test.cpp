#include "traces/models/implicit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <glm/geometric.hpp>
#include <map>

#include "traces/models/procedural.h"

namespace splatscope::traces {
namespace {

// Each edge belongs to as many triangles one way as the other: the surface has no border.
bool is_closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, count] : balance)
    if (count != 0) return false;
  return true;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += glm::dot(glm::dvec3(mesh.positions[t[0]]),
                    glm::cross(glm::dvec3(mesh.positions[t[1]]), glm::dvec3(mesh.positions[t[2]]))) /
           6;
  return sum;
}

TEST(Implicit, ABallsMeshIsABall) {
  Body body;
  add_ball(body, {0.1, 0.2, 0.3}, 0.5, {});
  const Mesh mesh = surface_of(body, 0.05);
  EXPECT_TRUE(is_closed(mesh));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 out = glm::dvec3(mesh.positions[i]) - glm::dvec3(0.1, 0.2, 0.3);
    EXPECT_NEAR(glm::length(out), 0.5, 1e-4);
    EXPECT_GT(glm::dot(glm::normalize(out), glm::normalize(glm::dvec3(mesh.normals[i]))), 0.9999);
  }
  EXPECT_NEAR(volume(mesh), 4 * 3.14159265358979 / 3 * 0.125, 0.005)
      << "the front of its triangles is outside";
}

// Blades, limbs of changing thickness and blends over borders of blocks.
TEST(Implicit, TheSurfaceOfABodyIsClosedAndOnIt) {
  Body body;
  const Vertebra spine[] = {
      {{-1, 0, 0}, 0.05}, {{-0.3, 0.2, 0}, 0.2}, {{0.4, 0, 0.1}, 0.1}, {{1, 0.1, 0}, 0.02}};
  add_limb(body, spine, {0, 0});
  add_limb(body, std::span(spine).first(2), {1, 0, {0, 1, 0}, 6});
  add_ball(body, {0.3, 0.2, 0}, 0.15, {2, 0.1});
  const Mesh mesh = surface_of(body, 0.02);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_GT(volume(mesh), 0);
  for (const glm::vec3& p : mesh.positions) ASSERT_LT(std::abs(distance(body, glm::dvec3(p))), 0.01);
}

TEST(Implicit, DoesNotDependOnTheNumberOfThreads) {
  Body body;
  add_ball(body, {0, 0, 0}, 0.5, {});
  add_ball(body, {0.5, 0.3, 0}, 0.3, {1, 0.2});
  const Mesh many = surface_of(body, 0.03);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Mesh single = surface_of(body, 0.03);
  EXPECT_EQ(many.positions, single.positions);
  EXPECT_EQ(many.triangles, single.triangles);
  EXPECT_EQ(many.parts, single.parts);
}

TEST(Procedural, TheSmallModelsAreClosedTwoUnitsAcrossWithTheirFrontOutside) {
  for (Generator generator : {Generator::sphere, Generator::torus_knot, Generator::salamander}) {
    const Model model = make_procedural(generator);
    EXPECT_GT(volume(model.mesh), 0);
    EXPECT_TRUE(generator == Generator::sphere ||
                is_closed(model.mesh));  // a sphere's faces share no vertices
    float least = 9, most = -9;
    for (const glm::vec3& p : model.mesh.positions) {
      least = std::min(least, p.x);
      most = std::max(most, p.x);
    }
    EXPECT_NEAR(most - least, 2, 0.3);
    for (const glm::vec3& n : model.mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-5);
  }
}

TEST(Procedural, TheStandInsHaveAsManySurfelsAsTable2) {
  EXPECT_EQ(default_count(Generator::salamander), 103389u);
  EXPECT_EQ(default_count(Generator::chameleon), 101685u);
  EXPECT_EQ(default_count(Generator::wasp), 273325u);
  EXPECT_EQ(default_count(Generator::fiesta), 352467u);
}

}  // namespace
}  // namespace splatscope::traces
