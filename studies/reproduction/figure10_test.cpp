#include "studies/reproduction/figure10.h"

#include <gtest/gtest.h>

#include "studies/reference_comparison.h"
#include "studies/run.h"

namespace splatscope::studies {
namespace {

traces::Scene small_knot() {
  return traces::parse_scene(
      "[surfels]\ngenerator = \"torus-knot\"\ncount = 4000\n[frame]\nwidth = 160\nheight = 160\n"
      "[capture]\nviews = 8\nframe_size = 160\n",
      "knot.toml");
}

TEST(Figure10, GammaKeepsTheSumsFromClamping) {
  const traces::Scene scene = small_knot();
  const double suitable = scene.splatting.gamma;
  const double gammas[] = {0.5 * suitable, suitable, 1};
  const auto rows =
      sweep_gamma(scene, gammas, machine::load(machine::kGeForce4), screen_space_reference(scene));
  ASSERT_EQ(3u, rows.size());
  EXPECT_EQ(0, rows[0].saturated);
  EXPECT_EQ(0, rows[0].clamped);
  // 1 surfel in 100 may have a larger sum (traces/gamma.h), and between the surfels it is larger still.
  EXPECT_LT(rows[1].saturated, 0.03);
  EXPECT_LT(rows[1].clamped, 0.03);
  // How the captured weights round by gamma scatters the picture by up to a decibel.
  EXPECT_NEAR(rows[0].psnr, rows[1].psnr, 1);
  EXPECT_GT(rows[2].saturated, 0.5);
  EXPECT_GT(rows[2].clamped, 0.5);
  EXPECT_LT(rows[2].psnr, rows[1].psnr - 6) << "half as near";
}

TEST(Figure10, WeightsMakeThePicture) {
  const traces::Scene scene = small_knot();
  const Machine machine = machine::load(machine::kGeForce4);
  const auto reference = screen_space_reference(scene);
  traces::CapturedWeights weights = traces::capture_weights(scene, machine.numbers);
  const double normalized = psnr(draw_frame(scene, weights, machine), reference);
  std::ranges::fill(weights.weights, traces::equal_weights(1));
  const double direct = psnr(draw_frame(scene, weights, machine), reference);
  EXPECT_GT(normalized, direct + 6);
}

}  // namespace
}  // namespace splatscope::studies
