#include "traces/hierarchy/block_culling.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "model/render.h"
#include "model/testing/random_seed.h"
#include "traces/recorder.h"
#include "traces/scene.h"

namespace splatscope::traces {
namespace {

Scene small_model(std::string_view generator) {
  return parse_scene(fmt::format("[surfels]\ngenerator = \"{}\"\ncount = 4000\n"
                                 "[frame]\nwidth = 80\nheight = 64\n[hierarchy]\nblock_surfels = 16\n",
                                 generator),
                     "model.toml");
}

// Anywhere about or inside a model of radius 1 about the origin, looking anywhere; the near plane may cut it.
Camera any_camera(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto direction = [&] {
    std::normal_distribution<double> any;
    return glm::normalize(glm::dvec3(any(random), any(random), any(random)));
  };
  Camera camera;
  camera.eye = between(0, 2.5) * direction();
  camera.target = camera.eye + direction();
  if (between(0, 1) < 0.7) camera.target = between(0, 0.8) * direction();
  camera.up = direction();
  camera.fov_y_degrees = between(10, 120);
  camera.near = std::exp2(between(-10, 0));
  camera.far = camera.near + between(0.5, 4);
  return camera;
}

// Orthonormal.
glm::dmat3 any_axes(std::mt19937& random) {
  std::normal_distribution<double> any;
  const glm::dvec3 z = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(any(random), any(random), any(random))));
  return {x, glm::cross(z, x), z};
}

// Of a part of such a model: much of it is outside, and much of it faces away.
Camera close_up() {
  Camera camera;
  camera.eye = {0, 0, 2.5};
  camera.target = {0.5, 0, 0};
  camera.up = {0, 1, 0};
  camera.fov_y_degrees = 6;
  camera.near = 0.1;
  camera.far = 10;
  return camera;
}

struct Drawn {
  splatscope::Frame frame;
  BlockCounts blocks;
};

Drawn drawn(Scene scene, const CapturedWeights& weights, Culling culling, const NumberFormats& formats = {}) {
  scene.hierarchy.culling = culling;
  const bool per_pixel = scene.splatting.algorithm == Algorithm::ewa_per_pixel;
  const Recording recording = per_pixel ? record(scene, NumberFormats{}) : record(scene, weights);
  RenderOptions options;
  options.formats = formats;
  options.record = Record::nothing;
  return {render(recording.trace, options).frame, recording.counts.blocks};
}

// Depths too: what is culled would have been nowhere.
void expect_same_pictures(const char* generator, const char* settings_name, auto&& change) {
  Scene scene = small_model(generator);
  change(scene);
  const Camera framed = scene.camera;
  const CapturedWeights weights = uniform_weights(scene.surfels.size(), scene.splatting.gamma);
  std::mt19937 random(random_seed());
  for (int i = 0; i < 30; ++i) {
    if (i == 1) {
      scene.camera = framed;  // with planes as they are by default
    } else {
      scene.camera = i == 0 ? close_up() : any_camera(random);
    }
    const Drawn all = drawn(scene, weights, Culling::off), some = drawn(scene, weights, Culling::blocks);
    ASSERT_EQ(all.frame, some.frame) << generator << ", " << settings_name << ", view " << i;
    const BlockCounts& blocks = some.blocks;
    const bool both_faces = scene.splatting.faces == Faces::both;
    if (both_faces) {
      EXPECT_EQ(0u, blocks.facing_away) << "view " << i;
    }
    if (i != 0) continue;
    // Or the test would say nothing: of a random view nobody knows how much is culled. What is outside and
    // faces away counts as the latter where a larger block does.
    const std::size_t a_twelfth = (blocks.surfels + blocks.outside_frustum + blocks.facing_away) / 12;
    EXPECT_GT(blocks.outside_frustum, a_twelfth) << generator;
    if (!both_faces) {
      EXPECT_GT(blocks.facing_away, a_twelfth) << generator;
    }
  }
}

TEST(BlockCulling, NeverChangesThePicture) {
  for (const char* generator : {"sphere", "torus-knot", "salamander"})
    expect_same_pictures(generator, "EWA", [](Scene&) {});
}

// Walls that face the eye from exactly where the far plane is, or the near one, seen from anywhere.
TEST(BlockCulling, NeverChangesThePictureOfAWallOnAClipPlane) {
  Scene scene = small_model("sphere");
  scene.splatting.algorithm = Algorithm::no_ewa;
  scene.surfels.resize(9);
  scene.camera = close_up();
  scene.camera.fov_y_degrees = 30;
  const CapturedWeights weights = uniform_weights(scene.surfels.size(), scene.splatting.gamma);
  NumberFormats nv20;
  nv20.vertex_arithmetic = Arithmetic::nv20;
  std::mt19937 random(random_seed());
  for (int tenths = 1; tenths <= 60; ++tenths) {
    const glm::dmat3 axes = tenths % 2 == 0 ? glm::dmat3(1) : any_axes(random);
    for (std::size_t i = 0; i < 9; ++i) {
      const auto across = static_cast<double>(i % 3), up = static_cast<double>(i / 3);
      scene.surfels[i].position = axes * glm::dvec3(0.1 * across, 0.1 * up, 0.1);
      scene.surfels[i].normal = -axes[2];
      scene.surfels[i].radius = 0.1f;
    }
    scene.camera.eye = axes * glm::dvec3(0, 0, -tenths / 10.0);
    scene.camera.target = axes * glm::dvec3(0, 0, 0.1);
    scene.camera.up = axes[1];
    const double wall = (tenths + 1) / 10.0;
    for (const bool at_far : {true, false}) {
      scene.camera.near = at_far ? wall / 10 : wall;
      scene.camera.far = at_far ? wall : 10 * wall;
      for (const NumberFormats& formats : {NumberFormats{}, nv20})
        ASSERT_EQ(drawn(scene, weights, Culling::off, formats).frame,
                  drawn(scene, weights, Culling::blocks, formats).frame)
            << wall << (at_far ? " at the far plane" : " at the near plane");
    }
  }
}

TEST(BlockCulling, NeverChangesThePictureWithoutPrefilter) {
  expect_same_pictures("torus-knot", "no EWA", [](Scene& s) { s.splatting.algorithm = Algorithm::no_ewa; });
}

TEST(BlockCulling, NeverChangesThePictureOfOtherSettings) {
  expect_same_pictures("torus-knot", "both faces", [](Scene& s) { s.splatting.faces = Faces::both; });
  expect_same_pictures("torus-knot", "levels", [](Scene& s) {
    s.splatting.algorithm = Algorithm::ewa_per_pixel;
    s.hierarchy.levels = true;
    s.hierarchy.surfels_per_pixel = 0.1;
  });
  expect_same_pictures("salamander", "large blocks of levels", [](Scene& s) {
    s.splatting.algorithm = Algorithm::ewa_per_pixel;
    s.hierarchy.levels = true;
    s.hierarchy.surfels_per_pixel = 0.02;
    s.hierarchy.block_surfels = 64;
  });
  expect_same_pictures("salamander", "depth offset along z", [](Scene& s) {
    s.splatting.depth_offset_scheme = DepthOffsetScheme::camera_z;
    s.splatting.depth_offset *= 4;
  });
  expect_same_pictures("salamander", "wide splats", [](Scene& s) {
    s.splatting.cutoff = 3;
    s.splatting.sigma = 2;
  });
  for (const std::string_view program : {"normal", "plane", "facing"}) {
    expect_same_pictures("torus-knot", "another vertex program",
                         [&](Scene& s) { s.splatting.ewa_program = program; });
  }
}

Block block_of(std::initializer_list<glm::vec3> positions, const glm::vec3& normal, float radius = 1) {
  std::vector<Surfel> surfels;
  for (const glm::vec3& position : positions) surfels.push_back({position, normal, radius, {}});
  return build_ldc_tree(surfels, 65536).levels.front().blocks.front();
}

// 90 degrees of view, 500 pixels each way: an eta of 250.
BlockFate fate_of(const Block& block, const Splatting& splatting, const glm::dvec3& target,
                  LeastCosines& known) {
  const kernels::View view = kernels::look_at({0, 0, 0}, target, {0, 1, 0}, 90, 500, 500, 1, 1000);
  return BlockCulling(view, splatting).fate(block, known);
}
BlockFate fate_of(const Block& block, const Splatting& splatting, const glm::dvec3& target = {0, 0, 1}) {
  LeastCosines known;
  return fate_of(block, splatting, target, known);
}

Splatting splatting_of(Faces faces = Faces::front, double depth_offset = 1) {
  Splatting splatting;
  splatting.cutoff = 1;
  splatting.sigma = 1;
  splatting.depth_offset = depth_offset;
  splatting.faces = faces;
  return splatting;
}

BlockFate fate_of(std::initializer_list<glm::vec3> positions, const glm::vec3& normal,
                  Faces faces = Faces::front) {
  const Block block = block_of(positions, normal);
  EXPECT_EQ(positions.size(), block.count);
  return fate_of(block, splatting_of(faces));
}
BlockFate fate_of(const glm::vec3& position, const glm::vec3& normal, Faces faces = Faces::front) {
  return fate_of({position}, normal, faces);
}

TEST(BlockCulling, KnowsWhatFacesAway) {
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 20}, {0, 0, -1}));
  EXPECT_EQ(BlockFate::facing_away, fate_of({0, 0, 20}, {0, 0, 1}));
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 20}, {0, 0, 1}, Faces::both));
  // The ray counts, not the camera's direction.
  EXPECT_EQ(BlockFate::facing_away, fate_of({15, 0, 20}, {1, 0, 0}));
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 20}, {1, 0, 0})) << "edge-on";
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 20}, {0.995f, 0, 0.0998f})) << "may turn on the pixel grid";
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 1.5f}, {0.6f, 0, 0.8f})) << "cut by the near plane";
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 999.5f}, {0.3f, 0, 0.954f})) << "cut by the far plane";
}

// 900 units away a quad is 0.54 pixels wide: 0.01 + (4 / 32 + 6 / 32^2 / 0.54) / 0.54 = 0.26 is the least
// cosine at which rounding its corners to the grid cannot turn it.
TEST(BlockCulling, SmallQuadsMayTurnOnTheGrid) {
  EXPECT_EQ(BlockFate::drawn, fate_of({0, 0, 900}, {std::sqrt(1 - 0.04f), 0, 0.2f}));
  EXPECT_EQ(BlockFate::facing_away, fate_of({0, 0, 900}, {std::sqrt(1 - 0.09f), 0, 0.3f}));
}

// A splat's corners reach 1.5 * 2 radii, at a distance of 1.25 that is 600 pixels a unit of radius: beyond
// the 32768 less the frame's sides that triangles are not clipped in.
TEST(BlockCulling, WhatTheGuardBandCutsIsDrawn) {
  const auto fate = [](float radius) {
    return fate_of(block_of({{0, 0, 1.25f}}, {0, 0, 1}, radius), splatting_of());
  };
  EXPECT_EQ(BlockFate::facing_away, fate(50));
  EXPECT_EQ(BlockFate::drawn, fate(56));
}

// Behind the eye, but the visibility pass moves its quads by 3 before it.
TEST(BlockCulling, TheDepthOffsetBringsQuadsBeforeTheEye) {
  const Block block = block_of({{0, 0, -1.5f}}, {0, 0, -1});
  EXPECT_EQ(BlockFate::outside_frustum, fate_of(block, splatting_of(Faces::front, 1)));
  EXPECT_EQ(BlockFate::drawn, fate_of(block, splatting_of(Faces::front, 3)));
}

// Along the camera's axis it moves the eye of that pass 5 units back, which then sees what the other does
// not.
TEST(BlockCulling, BothPassesMustCullABlock) {
  const Block block = block_of({{26, 0, 20}}, {0, 0, -1});
  Splatting splatting = splatting_of(Faces::front, 5);
  EXPECT_EQ(BlockFate::outside_frustum, fate_of(block, splatting));
  splatting.depth_offset_scheme = DepthOffsetScheme::camera_z;
  EXPECT_EQ(BlockFate::drawn, fate_of(block, splatting));
}

// Far beyond the right side, seen at a cosine of 0.02 and of 0.2: nearly edge-on nobody knows how long it is.
TEST(BlockCulling, SplatsWithoutAnAffineMapAreDrawn) {
  const glm::vec3 position(60, 0, 20), ray = glm::normalize(position), across(-ray.z, 0, ray.x);
  const auto seen_at = [&](float cosine) { return glm::normalize(across - cosine * ray); };
  EXPECT_EQ(BlockFate::drawn, fate_of(position, seen_at(0.02f)));
  EXPECT_EQ(BlockFate::outside_frustum, fate_of(position, seen_at(0.2f)));
}

// A row of surfels across the view, 20 units ahead, at 45 degrees to the axes: the corners of its box reach
// from 0.5 to 39.5.
TEST(BlockCulling, ACylinderHoldsWhatLiesAcrossTheBox) {
  const glm::vec3 ahead = glm::normalize(glm::vec3(1, 0, 1)), right = glm::normalize(glm::vec3(1, 0, -1));
  const Block block = block_of({20.0f * ahead - 19.5f * right, 20.0f * ahead + 19.5f * right}, ahead);
  ASSERT_EQ(block.count, 2u);
  EXPECT_EQ(BlockFate::facing_away, fate_of(block, splatting_of(), {1, 0, 1}));
}

// The eye is behind all of the block's planes, not behind that of its middle alone.
TEST(BlockCulling, LooksFromTheNearestPlane) {
  EXPECT_EQ(BlockFate::drawn, fate_of({{-2, 0, 20}, {18, 0, 20}}, {1, 0, 0}));
  EXPECT_EQ(BlockFate::facing_away, fate_of({{6, 0, 20}, {18, 0, 20}}, {1, 0, 0}));
}

// The cone of a block can tell more than those of the blocks below it.
TEST(BlockCulling, WhatIsKnownOfABlockCounts) {
  const Block block = block_of({{-2, 0, 20}, {18, 0, 20}}, {1, 0, 0});
  const auto fate = [&](const Block& seen, LeastCosines& known) {
    return fate_of(seen, splatting_of(), {0, 0, 1}, known);
  };
  LeastCosines known;
  EXPECT_EQ(BlockFate::drawn, fate(block, known));
  EXPECT_LT(known.away, 0) << "its cone tells nothing";
  known.away = 0.5;
  EXPECT_EQ(BlockFate::facing_away, fate(block, known));
  EXPECT_EQ(known.away, 0.5);
  known = {};
  EXPECT_EQ(BlockFate::facing_away, fate(block_of({{0, 0, 20}}, {0.6f, 0, 0.8f}), known));
  EXPECT_NEAR(known.away, 0.8, 1e-6);
  known = {};
  EXPECT_EQ(BlockFate::drawn, fate(block_of({{0, 0, 20}}, {0.6f, 0, -0.8f}), known));
  EXPECT_NEAR(known.toward, 0.8, 1e-6);
  // Outside, of normals that may be edge-on as far as its own cone tells.
  const glm::vec3 position(60, 0, 20), ray = glm::normalize(position), across(-ray.z, 0, ray.x);
  const Block edge_on = block_of({position}, glm::normalize(across - 0.02f * ray));
  known = {};
  EXPECT_EQ(BlockFate::drawn, fate(edge_on, known));
  known.toward = 0.2;
  EXPECT_EQ(BlockFate::outside_frustum, fate(edge_on, known));
}

TEST(BlockCulling, KnowsWhatIsOutside) {
  EXPECT_EQ(BlockFate::outside_frustum, fate_of({0, 0, -20}, {0, 0, 1}));
  EXPECT_EQ(BlockFate::outside_frustum, fate_of({0, 0, 1010}, {0, 0, -1}));
  for (const glm::vec2 side : {glm::vec2(1, 0), glm::vec2(-1, 0), glm::vec2(0, 1), glm::vec2(0, -1)}) {
    EXPECT_EQ(BlockFate::outside_frustum, fate_of({26.0f * side, 20}, {0, 0, -1}));
    EXPECT_EQ(BlockFate::drawn, fate_of({20.5f * side, 20}, {0, 0, -1})) << "its splat reaches in";
  }
}

}  // namespace
}  // namespace splatscope::traces
