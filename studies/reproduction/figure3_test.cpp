#include "studies/reproduction/figure3.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace splatscope::studies {
namespace {

traces::Scene knot(int count) {
  return traces::parse_scene("[surfels]\ngenerator = \"torus-knot\"\ncount = " + std::to_string(count) +
                                 "\n[frame]\nwidth = 160\nheight = 160\n",
                             "knot.toml");
}

TEST(Figure3, QuadsOfTwiceTheDistanceLeaveNoHole) {
  const traces::Scene scene = knot(3000);
  traces::Scene dense = knot(60000);
  dense.camera = scene.camera;
  const double sides[] = {0.5, 1, 2};
  const auto images = depth_images(scene, sides, visible_surface(dense), machine::load(machine::kGeForce4));
  ASSERT_EQ(3u, images.size());
  EXPECT_GT(images[0].inside_pixels, 5000u);
  EXPECT_GT(images[0].holes.size(), images[0].inside_pixels / 4);
  EXPECT_LT(images[1].holes.size(), images[0].holes.size() / 10);
  EXPECT_EQ(0u, images[2].holes.size());
}

// Without the near wall in the depth image, the far one behind it is no cover.
TEST(Figure3, ASurfaceFarBehindIsAHole) {
  const traces::Scene scene = knot(3000);
  traces::Scene without = scene;
  // The half of the knot that is nearer to the eye.
  const glm::dvec3 to_eye = glm::normalize(scene.camera.eye);
  std::erase_if(without.surfels, [&](const traces::Surfel& surfel) {
    return glm::dot(glm::dvec3(surfel.position), to_eye) > 0;
  });
  traces::Scene dense = knot(60000);
  dense.camera = scene.camera;
  const double sides[] = {2};
  const auto images = depth_images(without, sides, visible_surface(dense), machine::load(machine::kGeForce4));
  std::size_t covered = 0;
  for (const std::size_t pixel : images[0].holes) covered += images[0].frame.depth_value(pixel) < 1;
  EXPECT_GT(covered, 100u);
}

}  // namespace
}  // namespace splatscope::studies
