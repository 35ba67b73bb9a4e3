#include "studies/reproduction/zwicker_volumes.h"

#include <gtest/gtest.h>

#include <glm/mat2x2.hpp>

namespace splatscope::studies {
namespace {

TEST(ZwickerVolumes, TheAffineMapErrsByTheOpeningAngleOfTheKernel) {
  for (const double degrees : {0.0, 30.0}) {
    const AffineError small = affine_error(0.001, degrees), large = affine_error(0.01, degrees);
    EXPECT_GT(large.most, 5 * small.most);  // of first order off the line of sight, of second order on it
    EXPECT_LT(large.most, 150 * small.most);
    EXPECT_LT(large.most, 0.05);
    EXPECT_GT(small.most, 1e-9);
  }
}

TEST(ZwickerVolumes, RadiiAreTheRootsOfTheEigenvalues) {
  const Radii radii = radii_of(glm::dmat2{5, 4, 4, 5});
  EXPECT_NEAR(radii.larger, 3, 1e-12);
  EXPECT_NEAR(radii.smaller, 1, 1e-12);
}

// The paper's claims, with smaller textures and pictures.
TEST(ZwickerVolumes, EwaIsAheadOfSwanAndTheMoreSoTheLongerTheKernels) {
  double ahead[2] = {0, 0};  // by view
  const std::vector<ZebraCase> cases = zebra_cases(320, 100);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i].rows == cases[i].columns) continue;
    const ZebraRow row = compare_prefilters(cases[i]);
    EXPECT_GT(row.psnr_ewa - row.psnr_swan, ahead[i % 2]) << cases[i].name;
    ahead[i % 2] = row.psnr_ewa - row.psnr_swan;
  }
}

TEST(ZwickerVolumes, SurfaceKernelsShowATextureMoreSharply) {
  const KernelRow row = compare_kernels(160, zebra_cases(160, 100)[0].view);
  EXPECT_GT(row.psnr_surface, row.psnr_volume + 0.5);
}

}  // namespace
}  // namespace splatscope::studies
