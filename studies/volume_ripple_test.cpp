#include "studies/volume_ripple.h"

#include <gtest/gtest.h>

namespace splatscope::studies {
namespace {

TEST(VolumeRipple, IsSmallAtTheDefaultCutoffAndLargeAtThePapers) {
  for (const double pitch : {1.03, 2.11}) {
    EXPECT_LT(layer_ripple(11, pitch), 0.0025) << pitch;
    EXPECT_GT(layer_ripple(4, pitch), 0.02) << pitch;
    EXPECT_LT(layer_ripple(30, pitch), 1e-5) << pitch;  // of whole Gaussians: 2 e^(-2 pi^2) an axis
  }
}

}  // namespace
}  // namespace splatscope::studies
