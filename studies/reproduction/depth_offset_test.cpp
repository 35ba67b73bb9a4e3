// Fig. 4 and 5 on a small knot: what the two schemes hide, and z_t from too small to too large.
#include "studies/reproduction/depth_offset.h"

#include <gtest/gtest.h>

namespace splatscope::studies {
namespace {

traces::Scene small_knot() {
  return traces::parse_scene(
      "[surfels]\ngenerator = \"torus-knot\"\ncount = 4000\n[frame]\nwidth = 160\nheight = 160\n"
      "[camera]\neye = [0.2, 0.3, 1.5]\ntarget = [0, 0, 0]\nfov_y_degrees = 70\n"
      "[capture]\nviews = 8\nframe_size = 160\n",
      "knot.toml");
}

class DepthOffset : public testing::Test {
 protected:
  const traces::Scene scene_ = small_knot();
  const Machine machine_ = machine::load(machine::kGeForce4);
  const VisibleSurface surface_ = visible_surface(scene_);
  const traces::CapturedWeights weights_ = traces::capture_weights(scene_, machine_.numbers);
};

TEST_F(DepthOffset, AlongTheCamerasAxisHidesWhatIsVisible) {
  const auto counts = [&](traces::DepthOffsetScheme scheme) {
    return run_with_offset(scene_, scheme, scene_.splatting.depth_offset, weights_, machine_, surface_)
        .counts;
  };
  const FragmentCounts ray = counts(traces::DepthOffsetScheme::viewing_ray);
  const FragmentCounts z = counts(traces::DepthOffsetScheme::camera_z);
  EXPECT_EQ(ray.fragments, z.fragments);
  // Moved quads are flat, the rule's surface bends: a few fragments at silhouettes.
  EXPECT_LT(ray.wrongly_hidden, ray.fragments / 500);
  EXPECT_LT(ray.wrongly_kept, ray.fragments / 500);
  EXPECT_GT(z.wrongly_hidden, 20 * ray.wrongly_hidden);
  EXPECT_GT(z.wrongly_hidden, z.fragments / 100);
  EXPECT_GT(z.wrongly_kept, 20 * ray.wrongly_kept);
  EXPECT_EQ(0u, ray.holes);
}

TEST_F(DepthOffset, TooSmallTearsTheSurfaceAndTooLargeLetsOthersThrough) {
  constexpr double kSpacings[] = {0.1, 1, 16};
  const auto rows = sweep_offset(scene_, kSpacings, weights_, machine_, surface_);
  ASSERT_EQ(3u, rows.size());
  const FragmentCounts &small = rows[0].counts, &good = rows[1].counts, &large = rows[2].counts;
  EXPECT_GT(small.torn_pixels, small.surface_pixels / 2);
  EXPECT_LT(good.torn_pixels, small.torn_pixels / 3) << "so few surfels leave gaps at silhouettes";
  EXPECT_LT(large.torn_pixels, large.surface_pixels / 100);
  EXPECT_LT(good.leaking, good.kept / 100);
  EXPECT_GT(large.leaking, large.kept / 10);
}

}  // namespace
}  // namespace splatscope::studies
