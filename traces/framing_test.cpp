#include "traces/framing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "traces/scene.h"
#include "traces/splat_reach.h"
#include "traces/splat_trace.h"

namespace splatscope::traces {
namespace {

std::vector<Surfel> any_surfels() {
  const auto coordinate = [](int reach) { return static_cast<float>(*rc::gen::inRange(-reach, reach + 1)); };
  const int x = *rc::gen::element(1, 10, 1000), y = *rc::gen::element(1, 10, 1000),
            z = *rc::gen::element(1, 10, 1000);
  std::vector<Surfel> surfels(static_cast<std::size_t>(*rc::gen::inRange(2, 40)));
  for (Surfel& s : surfels) {
    s.position.x = 500 + coordinate(x);
    s.position.y = coordinate(y);
    s.position.z = coordinate(z);
    s.radius = 0.1f;
  }
  return surfels;
}

// All within the frame and between the planes; the one furthest out is near the frame's edge.
RC_GTEST_PROP(Framing, EverySurfelIsSeenAndTheFrameIsFilled, ()) {
  const std::vector<Surfel> surfels = any_surfels();
  const FrameSize frame{*rc::gen::element(100, 400), *rc::gen::element(100, 300)};
  Camera camera;
  frame_camera(surfels, frame, {}, camera);
  place_planes(depths_of(surfels, Splatting{.cutoff = 1, .sigma = 1}, frame, camera), {}, camera);
  RC_ASSERT(camera.near > 0 && camera.near < camera.far);
  const kernels::View view = view_of(camera, frame);
  double furthest = 0;
  for (const Surfel& s : surfels) {
    const glm::dvec3 p = view.camera_space(glm::dvec3(s.position));
    RC_ASSERT(p.z > camera.near && p.z < camera.far);
    const double r = s.radius;
    for (const glm::dvec3& off : {glm::dvec3(r, 0, 0), {-r, 0, 0}, {0, r, 0}, {0, -r, 0}}) {
      const glm::dvec2 window = view.window(p + off);
      furthest = std::max(
          {furthest, std::abs(2 * window.x / frame.width - 1), std::abs(2 * window.y / frame.height - 1)});
    }
  }
  RC_ASSERT(furthest < 1);
  RC_ASSERT(furthest > 0.9);
}

TEST(Framing, WhatIsGivenStays) {
  const Scene scene = parse_scene(
      "[surfels]\ngenerator = \"sphere\"\ncount = 200\n[camera]\neye = [0, 0, 9]\nfar = 50\n", "s.toml");
  EXPECT_EQ(scene.camera.eye, glm::dvec3(0, 0, 9));
  EXPECT_EQ(scene.camera.far, 50);
  EXPECT_NEAR(scene.camera.target.x, 0, 0.2) << "the middle of the surfels";
  EXPECT_GT(scene.camera.near, 6.5);
  EXPECT_LT(scene.camera.near, 8.2) << "just before them";
}

// Whose quads reach further where the filter is wider or cut off later.
TEST(Framing, ThePlanesHoldTheWholeSplats) {
  for (const auto& [sigma, cutoff] : {std::pair{1.0, 1.0}, {0.5, 1.0}, {1.0, 8.0}, {3.0, 4.0}}) {
    const Scene scene =
        parse_scene(fmt::format("[surfels]\ngenerator = \"sphere\"\ncount = 200\n[camera]\neye = [0, 0, 9]\n"
                                "target = [0, 0, 0]\n[splatting]\nsigma = {}\ncutoff = {}\n",
                                sigma, cutoff),
                    "s.toml");
    double nearest = 9, furthest = 0;
    for (const Surfel& s : scene.surfels) {
      for (const glm::dvec3& corner : quad_corners(s, scene.splatting)) {
        nearest = std::min(nearest, 9 - corner.z);
        furthest = std::max(furthest, 9 - corner.z);
      }
    }
    EXPECT_LE(scene.camera.near, nearest + 1e-6) << sigma << ' ' << cutoff;
    EXPECT_GE(scene.camera.far, furthest - 1e-6) << sigma << ' ' << cutoff;
  }
}

TEST(Framing, ThePlaneKeepsItsCamera) {
  const Scene scene = parse_scene("[surfels]\ncolumns = 4\nrows = 4\n", "s.toml");
  EXPECT_EQ(scene.camera.eye, glm::dvec3(0, 70, 225));
  EXPECT_EQ(scene.camera.far, 1000);
}

// Eq. 14 and 12: a square across the normal, sqrt(2c) sigma radii from its middle to its sides.
TEST(Framing, CornersOfASplatLieWhereItsDomainEnds) {
  const Surfel surfel{{1, 2, 3}, {0.6f, 0, 0.8f}, 0.5f, {}};
  Splatting splatting;
  splatting.cutoff = 2;
  splatting.sigma = 1.5;
  const auto corners = quad_corners(surfel, splatting);
  const double half_side = 2 * 1.5 * 0.5;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 out = corners[i] - glm::dvec3(surfel.position);
    EXPECT_NEAR(glm::dot(out, glm::dvec3(surfel.normal)), 0, 1e-6) << i;
    EXPECT_NEAR(glm::length(out), std::numbers::sqrt2 * half_side, 1e-6) << i;
    EXPECT_NEAR(glm::length(corners[i] - corners[(i + 1) % corners.size()]), 2 * half_side, 1e-6) << i;
  }
  EXPECT_NEAR(corner_reach(splatting) * surfel.radius, std::numbers::sqrt2 * half_side, 1e-12);
}

Splatting splatting_of(double depth_offset = 0) {
  Splatting splatting;
  splatting.cutoff = splatting.sigma = 1;
  splatting.depth_offset = depth_offset;
  return splatting;
}

// Of a surfel 8 units before an eye at the origin that looks along z, with an eta of half a side.
DepthRange depths_of_one(const glm::vec3& normal, float radius, const Splatting& splatting, int side = 64) {
  Camera camera;
  camera.target = {0, 0, 1};
  camera.fov_y_degrees = 90;
  const std::vector<Surfel> one{{{0, 0, 8}, normal, radius, {}}};
  return depths_of(one, splatting, {side, side}, camera);
}

// Two standard deviations to a corner, half as much again for other programs: a pixel is 8 / 32 there, and on
// a surfel that is seen at a cosine of 0.6 longer by 1 / 0.6, of which 0.8 lie along z. A tenth of the range
// is left on either side.
TEST(Framing, ThePlanesHoldTheLowPassFilter) {
  const DepthRange depths = depths_of_one({0.8f, 0, -0.6f}, 0.3f, splatting_of());
  const double reach = 1.5 * 2 * std::hypot(0.3, 0.25 / 0.6) * 0.8;
  EXPECT_NEAR(depths.nearest, 8 - 1.2 * reach, 1e-6);
  EXPECT_NEAR(depths.furthest, 8 + 1.2 * reach, 1e-6);
}

// Seen edge-on a filter has no end: it counts as if it were seen at a cosine of 0.15, and its corners as no
// further than a quarter of the distance.
TEST(Framing, ThePlanesOfWhatIsSeenEdgeOnAreNotWithoutEnd) {
  for (const auto& [side, filter] : {std::pair(256, 8 / (128 * 0.15)), {64, 0.25 * 8 / 2}}) {
    const DepthRange depths = depths_of_one({1, 0, 0}, 0.3f, splatting_of(), side);
    const double reach = 1.5 * 2 * std::hypot(0.3, filter);
    EXPECT_NEAR(depths.nearest, 8 - 1.2 * reach, 1e-6) << side;
    EXPECT_NEAR(depths.furthest, 8 + 1.2 * reach, 1e-6) << side;
  }
}

// The visibility pass moves its quads away from the eye; further than what there is to see they hide nothing.
TEST(Framing, TheFarPlaneHoldsTheDepthOffset) {
  for (const auto& [offset, furthest] : {std::pair(1.5, 10.7), {2.0, 11.2}, {1e30, 11.2}}) {
    const DepthRange depths = depths_of_one({0, 0, -1}, 0.5f, splatting_of(offset));
    EXPECT_DOUBLE_EQ(depths.nearest, 7 - 0.2) << offset;
    EXPECT_DOUBLE_EQ(depths.furthest, furthest) << offset;
  }
}

// Quads of the first pass reach sqrt 2 radii, and more room is left than that: 2, and a tenth of the range.
TEST(Framing, ThePlanesAreTwoRadiiFromSmallSplats) {
  Camera camera;
  camera.eye = {0, 0, -9};
  const std::vector<Surfel> one{{{0, 0, 0}, {0, 0, -1}, 0.5f, {}}};
  frame_camera(one, {64, 64}, {.eye = true}, camera);
  place_planes(depths_of(one, splatting_of(), {64, 64}, camera), {}, camera);
  EXPECT_DOUBLE_EQ(camera.near, 8 - 0.2);
  EXPECT_DOUBLE_EQ(camera.far, 10 + 0.2);
}

// With surfels on both sides of the eye the near plane is at a thousandth of the far one's distance.
TEST(Framing, ThePlanesOfAnEyeInsideAreNotTooFarApart) {
  Camera camera;
  camera.target = {0, 0, 1};
  const std::vector<Surfel> around{{{0, 0, -5}, {0, 0, 1}, 0.5f, {}}, {{0, 0, 9}, {0, 0, -1}, 0.5f, {}}};
  frame_camera(around, {64, 64}, {.eye = true, .target = true}, camera);
  place_planes(depths_of(around, splatting_of(), {64, 64}, camera), {}, camera);
  EXPECT_DOUBLE_EQ(camera.far, 10 + 0.1 * (10 + 5 + 1.5));
  EXPECT_DOUBLE_EQ(camera.near, 1e-3 * camera.far);
}

}  // namespace
}  // namespace splatscope::traces
