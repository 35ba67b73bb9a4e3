#include "studies/splat_fragments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "traces/recorder.h"

namespace splatscope::studies {
namespace {

// Two walls that face the eye, 4 and 8 units away; the nearer one, of red surfels, fills the middle.
traces::Scene two_walls(double depth_offset) {
  traces::Scene scene = traces::parse_scene(
      "[surfels]\ncolumns = 1\nrows = 1\n[frame]\nwidth = 64\nheight = 64\n[camera]\neye = [0, 0, 0]\n"
      "target = [0, 0, 1]\nfov_y_degrees = 60\nnear = 1\nfar = 20\n[splatting]\nalgorithm = "
      "\"ewa-per-pixel\"\n",
      "walls.toml");
  scene.splatting.depth_offset = depth_offset;
  scene.surfels.clear();
  for (const float z : {4.0f, 8.0f}) {
    const int half = z == 4 ? 2 : 20;
    for (int row = -half; row <= half; ++row) {
      for (int column = -half; column <= half; ++column) {
        scene.surfels.push_back({{0.25f * static_cast<float>(column), 0.25f * static_cast<float>(row), z},
                                 {0, 0, -1},
                                 0.3536f,
                                 {1, 0, 0}});
      }
    }
  }
  return scene;
}

struct Drawn {
  Trace trace;
  Rendered rendered;
};

Drawn draw(const traces::Scene& scene) {
  Trace trace = traces::record(scene, NumberFormats{}).trace;
  Rendered rendered = render(trace, {});
  return {std::move(trace), std::move(rendered)};
}

TEST(SplatFragments, TheNearestQuadIsVisible) {
  const traces::Scene scene = two_walls(0.25);
  const VisibleSurface surface = visible_surface(scene);
  const std::size_t middle = 32 * 64 + 32, beside = 32 * 64 + 6;
  EXPECT_NEAR(4, surface.depth[middle], 1e-6);
  EXPECT_LT(surface.surfel[middle], 25u);
  EXPECT_NEAR(8, surface.depth[beside], 1e-6);
  EXPECT_GE(surface.surfel[beside], 25u);
  EXPECT_TRUE(std::isinf(visible_surface(traces::parse_scene("", "plane.toml")).depth[0])) << "the sky";
}

// The walls are flat and stand apart: what a fragment belongs to is plain, and the machine agrees with the
// rule.
TEST(SplatFragments, FragmentsBelongToTheirWall) {
  const traces::Scene scene = two_walls(0.25);
  const VisibleSurface surface = visible_surface(scene);
  const auto [trace, rendered] = draw(scene);
  std::size_t before = 0;
  for_each_fragment(scene, trace, rendered, surface, [&](const SplatFragment& fragment) {
    const bool of_nearer_wall = fragment.surfel < 25;
    before += of_nearer_wall;
    const bool nearer_visible = surface.depth[fragment.pixel] < 5;
    if (!std::isfinite(surface.depth[fragment.pixel])) return;
    EXPECT_EQ(of_nearer_wall == nearer_visible ? Layer::visible
              : of_nearer_wall                 ? Layer::in_front
                                               : Layer::behind,
              fragment.layer);
    EXPECT_EQ(of_nearer_wall || !nearer_visible, fragment.kept_by_rule);
    EXPECT_GT(fragment.weight, 0);
  });
  EXPECT_GT(before, 1000u);
  const FragmentCounts counts = count_fragments(scene, trace, rendered, surface);
  EXPECT_GT(counts.fragments, counts.kept);
  // At the rim of the nearer wall the machine's quad may end a pixel earlier or later.
  EXPECT_LT(counts.wrongly_hidden + counts.wrongly_kept, counts.fragments / 200);
  EXPECT_EQ(0u, counts.holes);
  EXPECT_EQ(0u, counts.torn_pixels);
}

TEST(SplatFragments, WithTooLargeAnOffsetTheFartherWallLeaks) {
  const traces::Scene scene = two_walls(10);
  const VisibleSurface surface = visible_surface(scene);
  const auto [trace, rendered] = draw(scene);
  const FragmentCounts counts = count_fragments(scene, trace, rendered, surface);
  EXPECT_EQ(counts.fragments, counts.kept);
  EXPECT_EQ(0u, counts.wrongly_kept) << "by the rule of that offset";
  std::size_t nearer = 0;
  for (const double depth : surface.depth) nearer += depth < 5;
  EXPECT_EQ(nearer, counts.leaking_pixels);
}

// The nearer wall's middle surfel lies on the ray of pixel (32, 32): J is eta h / z = 55.43 * 0.3536 / 4
// = 4.900 times the unit matrix, and the filter 1 / (2 pi (1 + 1 / 4.900^2)) at its centre.
TEST(SplatFragments, AWeightIsTheFilterAtThePixel) {
  const traces::Scene scene = two_walls(0.25);
  const auto [trace, rendered] = draw(scene);
  double weight = 0;
  for_each_fragment(scene, trace, rendered, visible_surface(scene), [&](const SplatFragment& fragment) {
    if (fragment.surfel == 12 && fragment.pixel == 32 * 64 + 32) weight += fragment.weight;
  });
  EXPECT_NEAR(weight, 0.1528, 5e-5);
}

// Drawn with an offset of 10 all fragments are kept, with 0.25 those of the farther wall are hidden behind
// the nearer one: each is wrong by the rule of the other.
TEST(SplatFragments, PixelsAreMarkedByWhatIsWrongAtThem) {
  const traces::Scene hiding = two_walls(0.25), keeping = two_walls(10);
  const VisibleSurface surface = visible_surface(hiding);
  const std::size_t middle = 32 * 64 + 32, beside = 32 * 64 + 6;
  const auto [kept_trace, kept] = draw(keeping);
  const FragmentCounts too_many = count_fragments(hiding, kept_trace, kept, surface);
  EXPECT_EQ(too_many.wrongly_hidden, 0u);
  EXPECT_EQ(too_many.wrongly_kept, too_many.leaking);
  const Image blue = wrong_pixels(hiding, kept_trace, kept, surface);
  EXPECT_EQ(blue.pixels[middle], (std::array<float, 4>{0, 0, 1, 1}));
  const auto [hidden_trace, hidden] = draw(hiding);
  const FragmentCounts too_few = count_fragments(keeping, hidden_trace, hidden, surface);
  EXPECT_EQ(too_few.wrongly_hidden, too_few.fragments - too_few.kept);
  EXPECT_EQ(too_few.wrongly_kept, 0u);
  const Image red = wrong_pixels(keeping, hidden_trace, hidden, surface);
  EXPECT_EQ(red.pixels[middle], (std::array<float, 4>{1, 0, 0, 1}));
  // Right, and drawn in (1, 0, 0).
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(red.pixels[beside][c], 0.25 + 0.25 / 3, 0.01);
}

}  // namespace
}  // namespace splatscope::studies
