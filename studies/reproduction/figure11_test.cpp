#include "studies/reproduction/figure11.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "studies/reference_comparison.h"

namespace splatscope::studies {
namespace {

// The figure's view at a quarter of its size.
traces::Scene small_checkerboard(std::string_view algorithm) {
  return traces::parse_scene(
      fmt::format("[surfels]\ncolumns = 64\nrows = 64\n[frame]\nwidth = 128\nheight = 128\n"
                  "[camera]\neye = [0, 17.5, 56.25]\ntarget = [0, 0, 7.5]\n"
                  "[splatting]\nalgorithm = \"{}\"\n",
                  algorithm),
      "plane.toml");
}

TEST(Figure11, AliasesWithoutEwaAlone) {
  const Machine machine = machine::load(machine::kGeForce4);
  const kernels::SplatSums reference = single_surface_reference(small_checkerboard("ewa-per-pixel"));
  const auto decibels = [&](std::string_view algorithm) {
    return draw_checkerboard(small_checkerboard(algorithm), reference, machine).psnr;
  };
  const double aliased = decibels("no-ewa"), per_pixel = decibels("ewa-per-pixel"),
               per_surfel = decibels("ewa-per-surfel");
  EXPECT_GT(per_pixel, 44);
  EXPECT_GT(per_surfel, 25);
  EXPECT_LT(aliased, per_surfel - 5);
}

}  // namespace
}  // namespace splatscope::studies
