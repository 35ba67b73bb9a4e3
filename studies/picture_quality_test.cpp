// The study of picture quality on a small sphere: what it measures, and that each step of the budget costs
// what it should.
#include "studies/picture_quality.h"

#include <gtest/gtest.h>

#include <sstream>

#include "model/testing/scratch_folder.h"
#include "studies/run.h"

namespace splatscope::studies {
namespace {

QualityRow small_sphere(std::string_view splatting) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"sphere\"\ncount = 8000\n[frame]\nwidth = 160\nheight = 160\n"
      "[capture]\nviews = 16\nframe_size = 160\n[splatting]\n" +
          std::string(splatting),
      "sphere.toml");
  return quality_of("sphere", scene, machine::load(machine::kGeForce4));
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

// A dark surface of many splats.
traces::Scene dark_surface() {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex 1600\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "radius"})
    out << "property float " << name << '\n';
  for (const char* name : {"red", "green", "blue"}) out << "property uchar " << name << '\n';
  out << "end_header\n";
  for (int i = 0; i < 1600; ++i) out << i % 40 << ' ' << i / 40 << " 0 0 0 1 4 20 20 20\n";
  const ScratchFolder folder;
  return traces::parse_scene("[surfels]\nfile = '" + folder.file("dark.ply", out.str()).string() +
                                 "'\n[frame]\nwidth = 96\nheight = 96\n",
                             "dark.toml");
}

// So dark, and of so many splats and each of so little weight, that they round to nothing.
TEST(PictureQuality, NoDarkPixelIsAHole) {
  const traces::Scene scene = dark_surface();
  const Machine machine = machine::load(machine::kGeForce4);
  const Trace trace = traces::record(scene, machine.numbers).trace;
  const FrameRun run = run_frame(trace, machine, Fidelity::functional);
  const Comparison c = compare(run.rendered.frame, trace, machine, screen_space_reference(scene));
  EXPECT_EQ(c.holes, 0u);
  EXPECT_GT(c.rounded_to_black, 0u);
}

// Weights that the vertices' 8-bit colours do not hold: the splats are there all the same.
TEST(PictureQuality, NoPixelOfFaintSplatsIsAHole) {
  const traces::Scene scene = dark_surface();
  const Machine machine = machine::load(machine::kGeForce4);
  const Trace trace = traces::record(scene, traces::uniform_weights(scene.surfels.size(), 0.001)).trace;
  const Comparison c = compare(draw_frame(trace, machine), trace, machine, screen_space_reference(scene));
  EXPECT_EQ(c.holes, 0u);
  EXPECT_EQ(c.rounded_to_black, c.inside_pixels);
  EXPECT_GT(c.inside_pixels, 0u);
}

TEST(PictureQuality, RealModelsAreThoseThatAreThere) {
  const ScratchFolder folder;
  EXPECT_TRUE(real_models(folder / "nowhere").empty());
  folder.file("bunny.obj", "v 0 0 0\n");
  const std::vector<ModelScene> models = real_models(folder.path());
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0].name, "bunny");
}

}  // namespace
}  // namespace splatscope::studies
