// The study of picture quality on a small sphere: what it measures, and that each step of the budget costs
// what it should.
#include "studies/picture_quality.h"

#include <gtest/gtest.h>

#include <fstream>

namespace splatscope::studies {
namespace {

QualityRow small_sphere(std::string_view splatting) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"sphere\"\ncount = 8000\n[frame]\nwidth = 160\nheight = 160\n"
      "[capture]\nviews = 16\nframe_size = 160\n[splatting]\n" +
          std::string(splatting),
      "sphere.toml");
  return quality_of("sphere", scene, machine::load("geforce4-ti4400"));
}

TEST(PictureQuality, TheWeightsAndTheEdgesCostWhatEightBitsDoNot) {
  const QualityRow row = small_sphere("");
  EXPECT_EQ(row.surfels, 8000u);
  EXPECT_EQ(row.per_pixel.holes, 0u);
  EXPECT_GT(row.per_pixel.psnr, 36);
  // What keeps a picture with weights per surfel from the reference is the weights and the edges, not 8 bits.
  EXPECT_NEAR(row.per_surfel.psnr_off_edges, row.captured.psnr_off_edges, 1);
  EXPECT_NEAR(row.float_frame.psnr_off_edges, row.captured.psnr_off_edges, 1);
  EXPECT_LT(row.per_surfel.psnr, row.per_surfel.psnr_off_edges);
  EXPECT_GT(row.same_weights.psnr, 36);  // at edges too
  EXPECT_GT(row.capture_seconds, 0);
}

TEST(PictureQuality, FiltersThatEndLateAreSmoother) {
  EXPECT_GT(small_sphere("cutoff = 2\nsigma = 0.7071\n").per_surfel.psnr_off_edges,
            small_sphere("").per_surfel.psnr_off_edges);
}

TEST(PictureQuality, RealModelsAreThoseThatAreThere) {
  const std::filesystem::path folder = testing::TempDir();
  EXPECT_TRUE(real_models(folder / "nowhere").empty());
  std::ofstream(folder / "bunny.obj") << "v 0 0 0\n";
  const std::vector<ModelScene> models = real_models(folder);
  std::filesystem::remove(folder / "bunny.obj");
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0].name, "bunny");
}

}  // namespace
}  // namespace splatscope::studies
