#include "kernels/reference/volume/volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "kernels/reference/volume/procedural.h"
#include "kernels/reference/volume/transfer_function.h"

namespace splatscope::kernels {
namespace {

// values = 2x - 3y + 5z in object units
Volume ramp() {
  Volume volume = centered_volume({4, 5, 6}, {0.5, 1, 2});
  for (int z = 0; z < 6; ++z) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 4; ++x) {
        const glm::dvec3 p = volume.position({x, y, z});
        volume.values[volume.index({x, y, z})] = static_cast<float>(2 * p.x - 3 * p.y + 5 * p.z);
      }
    }
  }
  return volume;
}

TEST(Volume, GradientIsByObjectUnitsUpToTheFaces) {
  const Volume volume = ramp();
  for (const glm::ivec3 voxel : {glm::ivec3(1, 2, 3), glm::ivec3(0, 0, 0), glm::ivec3(3, 4, 5)}) {
    EXPECT_EQ(gradient(volume, voxel), glm::dvec3(2, -3, 5));
  }
  EXPECT_EQ(gradient(constant_volume({1, 1, 1}, glm::dvec3(1)), {0, 0, 0}), glm::dvec3(0));
}

TEST(Volume, LiesAboutTheOrigin) {
  const Volume volume = ramp();
  EXPECT_EQ(volume.position({0, 0, 0}) + volume.position({3, 4, 5}), glm::dvec3(0));
  EXPECT_EQ(volume.center(), glm::dvec3(0));
  EXPECT_EQ(volume.extent(), glm::dvec3(2, 5, 12));
}

TEST(Volume, FlatteningShrinksAlongTheNormalAlone) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 2, 2));
  const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(1, 0, 0)));
  const glm::dmat3 flat = flattened(glm::dmat3(4.0), normal, 10);
  EXPECT_NEAR(glm::dot(normal, flat * normal), 0.04, 1e-12);
  EXPECT_NEAR(glm::dot(across, flat * across), 4, 1e-12);
  EXPECT_NEAR(glm::dot(across, flat * normal), 0, 1e-12);
}

TEST(Volume, AFlattenedSphereHasTheOpacityOfTheSphereInItsMiddle) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 2, 2));
  // Seen along z: what is integrated goes with the root of the determinant across it.
  for (const double s : {1.0, 1.001, 2.0, 100.0}) {
    const double across = glm::determinant(glm::dmat2(flattened(glm::dmat3(1.0), normal, s)));
    EXPECT_NEAR(flattened_weight(normal.z, s), std::sqrt(across), 1e-12) << s;
  }
  EXPECT_EQ(flattened_weight(-0.3, 1), 1);
  EXPECT_NEAR(flattened_weight(-0.3, 1e4), 0.3, 1e-7);
}

TEST(Volume, CurvilinearKernelsFollowTheMap) {
  const Volume grid = ramp();
  const auto [samples, layers] = curvilinear_samples(grid, 1, [&](const glm::ivec3& voxel) {
    const glm::dvec3 p = grid.position(voxel);
    return glm::dvec3(p.y, 2 * p.x, p.z + 0.5 * p.y);
  });
  ASSERT_EQ(samples.size(), grid.values.size());
  ASSERT_EQ(layers.voxels.size(), samples.size());
  EXPECT_EQ(layers.voxels[1], glm::ivec3(1, 0, 0));
  // The layers of constant p.y are planes of constant x; those of constant p.z slope by a half of x.
  EXPECT_NEAR(layers.facing[1].least_along({1, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(layers.facing[2].least_along({0, 0, 1}), 1 / std::hypot(1, 0.5), 1e-12);
  EXPECT_NEAR(layers.facing[2].least_along({1, 0, 0}), -0.5 / std::hypot(1, 0.5), 1e-12);
  for (const VolumeSample& sample : samples) {
    EXPECT_NEAR(sample.cell, 2 * (0.5 * 1 * 2), 1e-12);  // the map doubles volumes
    EXPECT_NEAR(glm::determinant(sample.variance), sample.cell * sample.cell, 1e-9);
    // value = 2x - 3y + 5z with x = q/2, y = p, z = r - p/2
    EXPECT_NEAR(glm::length(sample.gradient - glm::dvec3(-5.5, 1, 5)), 0, 1e-6);
  }
}

TEST(Volume, CollapsedCellsHaveNeitherVolumeNorGradient) {
  const Volume grid = ramp();
  const auto first = [&](float value) { return value == grid.values[0]; };
  const auto [samples, layers] = curvilinear_samples(
      grid, 1, [](const glm::ivec3& v) { return glm::dvec3(v.x, v.x, v.z); }, first);
  const auto seen = static_cast<std::size_t>(std::ranges::count_if(grid.values, first));
  ASSERT_LT(seen, grid.values.size());
  EXPECT_EQ(samples.size(), seen) << "the others are not seen";
  EXPECT_FALSE(layers.facing[2].least_along({0, 0, 1}) > -1) << "no layer faces anywhere";
  for (const VolumeSample& sample : samples) {
    EXPECT_EQ(sample.cell, 0);
    EXPECT_EQ(sample.gradient, glm::dvec3(0));
  }
}

TEST(Volume, ProceduralOnesHoldFiniteValuesFromZeroToOne) {
  for (const Volume& volume : {marschner_lobb(20), concentric_shells(20, 3), zebra_texture(32, 16, 3, 0.25),
                               head_stand_in({32, 32, 14})}) {
    ASSERT_EQ(volume.values.size(), volume.index(volume.size - 1) + 1);
    float low = 1, high = 0;
    for (const float value : volume.values) {
      ASSERT_TRUE(value >= 0 && value <= 1);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    EXPECT_LT(low, 0.15);
    EXPECT_GT(high, 0.8);
  }
}

TEST(TransferFunction, RunsStraightBetweenPointsAndStepsWhereTwoHaveOneValue) {
  const TransferFunction function({{1, {0.2, {1, 0, 0}}}, {2, {0.6, {0, 1, 0}}}, {2, {0.9, {0, 0, 1}}}});
  EXPECT_DOUBLE_EQ(function(0).opacity, 0.2);
  EXPECT_DOUBLE_EQ(function(1.5).opacity, 0.4);
  EXPECT_EQ(function(1.5).color, glm::dvec3(0.5, 0.5, 0));
  EXPECT_DOUBLE_EQ(function(2).opacity, 0.9);
  EXPECT_DOUBLE_EQ(function(3).opacity, 0.9);
}

}  // namespace
}  // namespace splatscope::kernels
