#include "traces/models/model_surfels.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "traces/models/parametric.h"

namespace splatscope::traces {
namespace {

Model ball(double radius) {
  Model model;
  model.mesh = sphere(8, [&](const glm::dvec3&) { return radius; });
  mend(model.mesh);
  model.paint = [](const SurfacePoint&) { return glm::vec3(1); };
  return model;
}

// Near 1000 binary32 has steps of 6e-5: the triangle has 45 places.
TEST(ModelSurfels, ACopyIsAsLargeAsWhatItIsACopyOf) {
  Model model = ball(1);
  model.mesh = {};
  model.mesh.positions = {{1000, 1000, 1000}, {1000.0005f, 1000, 1000}, {1000, 1000.0005f, 1000}};
  model.mesh.triangles = {{0, 1, 2}};
  mend(model.mesh);
  const ModelSurfels made = sample_model(model, {.count = 100, .neighbours = 8});
  ASSERT_EQ(made.surfels.size(), 100u);
  EXPECT_GE(made.copies, 55u);
  std::map<std::tuple<float, float>, float> radii;
  for (const Surfel& s : made.surfels)
    EXPECT_EQ(radii.emplace(std::tuple(s.position.x, s.position.y), s.radius).first->second, s.radius);
}

// Sizes of patterns are in radii: a model eight times as large looks the same.
TEST(ModelSurfels, APatternGrowsWithItsModel) {
  const ModelOptions options{
      .count = 500, .pattern = Pattern::checker, .pattern_scale = 0.5, .neighbours = 8};
  const ModelSurfels small = sample_model(ball(1), options), large = sample_model(ball(8), options);
  std::size_t light = 0;
  for (std::size_t i = 0; i < small.surfels.size(); ++i) {
    ASSERT_EQ(8.0f * small.surfels[i].position, large.surfels[i].position) << i;
    EXPECT_EQ(small.surfels[i].color, large.surfels[i].color) << i;
    light += small.surfels[i].color.r > 0.1f;
  }
  EXPECT_GT(light, 100u);
  EXPECT_LT(light, 400u);
}

}  // namespace
}  // namespace splatscope::traces
