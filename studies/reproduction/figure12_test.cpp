#include "studies/reproduction/figure12.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace splatscope::studies {
namespace {

traces::Scene small_model(std::string_view algorithm) {
  return traces::parse_scene(
      fmt::format(
          "[surfels]\ngenerator = \"torus-knot\"\npattern = \"zebra\"\npattern_scale = 0.04\ncount = 16000\n"
          "[frame]\nwidth = 128\nheight = 128\n[capture]\nviews = 8\nframe_size = 128\n"
          "[splatting]\nalgorithm = \"{}\"\n",
          algorithm),
      "model.toml");
}

TEST(Figure12, AFinePatternIsSmoothWithoutHoles) {
  const Machine machine = machine::load(machine::kGeForce4);
  const Comparison ewa = draw_model(small_model("ewa-per-surfel"), machine).comparison;
  EXPECT_GT(ewa.pixels_off_edges, 1000u);
  EXPECT_EQ(ewa.holes, 0u);
  EXPECT_GT(ewa.psnr_off_edges, 33);
  EXPECT_LT(ewa.psnr, ewa.psnr_off_edges) << "edges fade";
  const Comparison aliased = draw_model(small_model("no-ewa"), machine).comparison;
  EXPECT_LT(aliased.psnr_off_edges, ewa.psnr_off_edges - 4);
}

}  // namespace
}  // namespace splatscope::studies
