#include "studies/alpha_texture.h"

#include <gtest/gtest.h>

#include "kernels/object_space_ewa/alpha_texture.h"

namespace splatscope::studies {
namespace {

TEST(AlphaTextureStudy, EquationSixteenIsTheLeastSize) {
  for (const double cutoff : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    const int optimal = kernels::optimal_length(cutoff), least = least_length(cutoff);
    // Rounding to 8 bits can hide a slope a little above a step a texel: most where the Gaussian is short.
    EXPECT_LE(least, optimal) << "c = " << cutoff;
    EXPECT_GT(least, 0.9 * optimal) << "c = " << cutoff;
    EXPECT_EQ(1, describe_texture(cutoff, optimal).largest_step);
    EXPECT_EQ(2, describe_texture(cutoff, least - 1).largest_step);
  }
}

TEST(AlphaTextureStudy, LargerTexturesOnlyRepeat) {
  const TextureRow half = describe_texture(1, 219), optimal = describe_texture(1, 438),
                   twice = describe_texture(1, 876);
  EXPECT_EQ(half.values, optimal.values);
  EXPECT_EQ(optimal.values, twice.values);
  EXPECT_LT(half.repeated, optimal.repeated);
  EXPECT_NEAR(0.5 * (1 + optimal.repeated), twice.repeated, 0.01) << "each texel twice";
  EXPECT_DOUBLE_EQ(2, twice.of_optimal);
}

TEST(AlphaTextureStudy, LengthsDecideTheCircularCutoff) {
  traces::Scene scene = traces::parse_scene(
      "[surfels]\ncolumns = 48\nrows = 48\n[frame]\nwidth = 96\nheight = 96\n[camera]\n"
      "eye = [0, 13, 42]\ntarget = [0, 0, 6]\n[splatting]\nalgorithm = \"ewa-per-pixel\"\n",
      "plane.toml");
  const int lengths[] = {27, 438, 876};
  const Machine machine = machine::load(machine::kGeForce4);
  const auto circle = texture_rows(scene, lengths, machine);
  scene.splatting.circular_cutoff = false;
  const auto square = texture_rows(scene, lengths, machine);
  EXPECT_GT(circle[1].psnr_float, circle[0].psnr_float + 6);
  EXPECT_LT(std::abs(square[1].psnr_float - square[0].psnr_float), 3) << "edges of polygons need no texels";
  EXPECT_GT(circle[1].psnr_float, circle[1].psnr) << "8 bits of frame buffer";
}

}  // namespace
}  // namespace splatscope::studies
