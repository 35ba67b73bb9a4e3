#include "traces/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/error.h"
#include "model/testing/error_of.h"
#include "traces/scene_settings.h"

namespace splatscope::traces {
namespace {

std::string scene_error(std::string_view text) {
  return splatscope::error_of([&] { parse_settings(text, "s.toml"); });
}

TEST(Scene, EmptyFileIsThePlaneOfFigure11) {
  const Scene scene = parse_scene("", "empty.toml");
  EXPECT_EQ(scene.name, "empty");
  EXPECT_EQ(scene.surfels.size(), 65536u);
  EXPECT_EQ(scene.frame.width, 512);
  EXPECT_EQ(scene.frame.height, 512);
  EXPECT_EQ(scene.splatting.algorithm, Algorithm::ewa_per_surfel);
  EXPECT_EQ(scene.splatting.cutoff, 1);
  EXPECT_EQ(scene.splatting.gamma, 0.73);
  EXPECT_EQ(scene.splatting.depth_offset, 1) << "the spacing of the plane";
  EXPECT_TRUE(scene.splatting.circular_cutoff);
  EXPECT_EQ(scene.splatting.vertex_memory, VertexMemory::automatic);
  EXPECT_EQ(scene.splatting.faces, Faces::both);
  EXPECT_EQ(scene.hierarchy.culling, Culling::none);
}

TEST(Scene, PlaneIsCentredWithSquaresOfTwoColours) {
  const Scene scene = parse_scene(
      "[surfels]\ncolumns = 6\nrows = 4\nchecker_square = 2\nchecker_light = [1, 0.5, 0]\nchecker_dark = [0, "
      "0, 1]\n",
      "plane.toml");
  ASSERT_EQ(scene.surfels.size(), 24u);
  glm::vec3 sum(0);
  std::size_t i = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 6; ++column) {
      const Surfel& s = scene.surfels[i++];
      EXPECT_EQ(s.position, glm::vec3(column - 2.5, 0, row - 1.5));
      EXPECT_EQ(s.normal, glm::vec3(0, 1, 0));
      EXPECT_FLOAT_EQ(s.radius, std::sqrt(2.0f));
      const bool light = (row / 2 + column / 2) % 2 == 0;
      EXPECT_EQ(s.color, light ? glm::vec3(1, 0.5, 0) : glm::vec3(0, 0, 1));
      sum += s.position;
    }
  }
  EXPECT_EQ(sum, glm::vec3(0));
}

TEST(Scene, EveryKeyIsRead) {
  const SceneSettings s = parse_settings(R"(
[surfels]
file = "x.ply"
mirror = true
neighbours = 9
[camera]
eye = [1, 2, 3]
target = [4.5, 5, 6]
up = [0, 0, 1]
fov_y_degrees = 30
near = 0.5
far = 20
[frame]
width = 7
height = 8
[splatting]
algorithm = "no-ewa"
cutoff = 2
depth_offset = 0.125
depth_offset_scheme = "camera-z"
gamma = 0.5
sigma = 0.75
circular_cutoff = false
texture_length = 200
vertex_memory = "agp"
video_megabytes = 12.5
faces = "front"
[hierarchy]
culling = "off"
block_surfels = 64
level = "auto"
surfels_per_pixel = 0.5
progressive = true
[capture]
views = 5
frame_size = 100
corner_weights = false
box_min = [-1, -2, -3]
box_max = [1, 2, 3]
)",
                                         "s.toml");
  EXPECT_EQ(s.surfels.file, "x.ply");
  EXPECT_TRUE(s.surfels.mirror);
  EXPECT_EQ(s.surfels.neighbours, 9);
  EXPECT_EQ(s.camera.eye, glm::dvec3(1, 2, 3));
  EXPECT_EQ(s.camera.target, glm::dvec3(4.5, 5, 6));
  EXPECT_EQ(s.camera.up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(s.camera.fov_y_degrees, 30);
  EXPECT_EQ(s.camera.near, 0.5);
  EXPECT_EQ(s.camera.far, 20);
  EXPECT_EQ(s.width, 7);
  EXPECT_EQ(s.height, 8);
  EXPECT_EQ(s.splatting.algorithm, Algorithm::no_ewa);
  EXPECT_EQ(s.splatting.cutoff, 2);
  EXPECT_EQ(s.depth_offset, 0.125);
  EXPECT_EQ(s.splatting.depth_offset_scheme, DepthOffsetScheme::camera_z);
  EXPECT_EQ(s.splatting.gamma, 0.5);
  EXPECT_EQ(s.splatting.sigma, 0.75);
  EXPECT_FALSE(s.splatting.circular_cutoff);
  EXPECT_EQ(s.splatting.texture_length, 200);
  EXPECT_EQ(s.splatting.vertex_memory, VertexMemory::agp);
  EXPECT_EQ(s.splatting.video_megabytes, 12.5);
  EXPECT_EQ(s.splatting.faces, Faces::front);
  EXPECT_EQ(s.hierarchy.culling, Culling::off);
  EXPECT_EQ(s.hierarchy.block_surfels, 64);
  EXPECT_TRUE(s.hierarchy.levels);
  EXPECT_EQ(s.hierarchy.surfels_per_pixel, 0.5);
  EXPECT_TRUE(s.hierarchy.progressive);
  EXPECT_EQ(s.capture.views, 5);
  EXPECT_EQ(s.capture.frame_size, 100);
  EXPECT_FALSE(s.capture.corner_weights);
  EXPECT_EQ(s.capture.box_min, glm::dvec3(-1, -2, -3));
  EXPECT_EQ(s.capture.box_max, glm::dvec3(1, 2, 3));
}

// A right-handed file is the same model in a left-handed scene, the other way round.
TEST(Scene, ModelsAreMirrored) {
  const std::string model = "[surfels]\ngenerator = \"salamander\"\ncount = 200\n";
  const Scene plain = parse_scene(model, "s.toml"),
              mirrored = parse_scene(model + "mirror = true\n", "s.toml");
  ASSERT_EQ(plain.surfels.size(), mirrored.surfels.size());
  const glm::vec3 other_way(-1, 1, 1);
  for (std::size_t i = 0; i < plain.surfels.size(); ++i) {
    EXPECT_EQ(plain.surfels[i].position * other_way, mirrored.surfels[i].position);
    EXPECT_EQ(plain.surfels[i].normal * other_way, mirrored.surfels[i].normal);
    EXPECT_EQ(plain.surfels[i].color, mirrored.surfels[i].color);
  }
}

TEST(Scene, ErrorsNameLineAndExpectation) {
  EXPECT_EQ(scene_error("[frame]\nwidth = \"big\"\n"),
            "s.toml:2: frame.width is 'big', expected a whole number from 1 to 4096");
  EXPECT_EQ(scene_error("[frame]\n\nwidth = 0\n"),
            "s.toml:3: frame.width is 0, expected a whole number from 1 to 4096");
  EXPECT_EQ(scene_error("[frame]\nwidth = 1.5\n"),
            "s.toml:2: frame.width is 1.5, expected a whole number from 1 to 4096");
  EXPECT_EQ(scene_error("[frame]\nwidht = 5\n"),
            "s.toml:2: unknown key \"widht\" in [frame], expected one of: width, height");
  EXPECT_EQ(scene_error("[cmaera]\n"),
            "s.toml:1: unknown table \"cmaera\", expected one of: surfels, camera, frame, splatting, "
            "hierarchy, capture, volume");
  EXPECT_EQ(scene_error("camera = 3\n"), "s.toml:1: \"camera\" is a value, expected a table [camera]");
  EXPECT_EQ(scene_error("[splatting]\nalgorithm = \"EWA\"\n"),
            "s.toml:2: splatting.algorithm is 'EWA', expected one of \"no-ewa\", \"ewa-per-pixel\", "
            "\"ewa-per-surfel\"");
  EXPECT_EQ(scene_error("[splatting]\ngamma = nan\n"),
            "s.toml:2: splatting.gamma is nan, expected a number from 0 to 1");
  EXPECT_EQ(scene_error("[splatting]\ncircular_cutoff = 1\n"),
            "s.toml:2: splatting.circular_cutoff is 1, expected true or false");
  EXPECT_EQ(scene_error("[splatting]\ntexture_length = 2049\n"),
            "s.toml:2: splatting.texture_length is 2049, expected a whole number from 0 to 2048");
  EXPECT_EQ(scene_error("[splatting]\nrefine = true\nalgorithm = \"no-ewa\"\n"),
            "s.toml:2: splatting.refine with algorithm \"no-ewa\", expected \"ewa-per-surfel\"");
  EXPECT_EQ(scene_error("[camera]\neye = [1, 2]\n"),
            "s.toml:2: camera.eye is [ 1, 2 ], expected an array of three numbers from -1e+30 to 1e+30");
  EXPECT_EQ(scene_error("[camera]\neye = [1, inf, 2]\n"),
            "s.toml:2: camera.eye is [ 1, inf, 2 ], expected an array of three numbers from -1e+30 to 1e+30");
}

TEST(Scene, ErrorsShowLittleOfALongValue) {
  EXPECT_EQ(
      scene_error("[frame]\nwidth = \"" + std::string(100, 'w') + "\"\n"),
      "s.toml:2: frame.width is '" + std::string(56, 'w') + "..., expected a whole number from 1 to 4096");
}

TEST(Scene, ADepthOffsetIsTheSpacingUnlessItIsGiven) {
  constexpr const char* kPlane = "[surfels]\ncolumns = 4\nrows = 4\n";
  EXPECT_EQ(parse_scene(kPlane, "s.toml").splatting.depth_offset, 1);
  EXPECT_EQ(parse_scene(std::string(kPlane) + "[splatting]\ndepth_offset = 0.25\n", "s.toml")
                .splatting.depth_offset,
            0.25);
}

TEST(Scene, AMeshIsDescribedByWhatIsWrongWithIt) {
  EXPECT_EQ(
      describe(MeshCounts{.triangles = 1,
                          .triangles_not_finite = 2,
                          .triangles_out_of_range = 3,
                          .triangles_degenerate = 4,
                          .normals_computed = 5,
                          .textures_unreadable = 6,
                          .materials_unreadable = 7}),
      "from 1 triangles, 9 left out (2 not finite, 3 with a corner that does not exist, 4 without area), "
      "5 normals computed, 6 textures unreadable, 7 files of materials unreadable");
}

TEST(Scene, CameraMustSeeSomething) {
  EXPECT_EQ(scene_error("[camera]\nfar = 5\nnear = 5\n"),
            "s.toml:3: camera.near is 5 and camera.far 5, expected near < far");
  EXPECT_EQ(scene_error("[camera]\n\nfar = 0.5\n"),
            "s.toml:3: camera.near is 1 and camera.far 0.5, expected near < far");
  EXPECT_EQ(scene_error("\n[camera]\ntarget = [1, 1, 1]\neye = [1, 1, 1]\n"),
            "s.toml:4: camera.eye equals camera.target, expected two points");
  EXPECT_EQ(scene_error("[camera]\nup = [0, 0, 0]\n"), "s.toml:2: camera.up is zero, expected a direction");
  EXPECT_EQ(scene_error("camera.target = [0, 1, 0]\ncamera.eye = [0, 9, 0]\n"),
            "s.toml:2: camera.up is [0, 1, 0], along the line of sight, expected another direction");
}

TEST(Scene, KeysOfTheHierarchyHaveSomethingToActOn) {
  const std::string plane = "[hierarchy]\n", sphere = "surfels.generator = \"sphere\"\n[hierarchy]\n";
  for (const std::string key :
       {"block_surfels = 64", "level = \"auto\"", "surfels_per_pixel = 2", "progressive = true"}) {
    const std::string name = key.substr(0, key.find(' '));
    EXPECT_EQ(
        scene_error(plane + key + "\n"),
        fmt::format("s.toml:2: hierarchy.{} without a hierarchy, expected it removed, or hierarchy.culling = "
                    "\"off\" (every block) or \"blocks\", as the plane has none by default",
                    name));
    EXPECT_EQ(
        scene_error(sphere + key + "\nculling = \"none\"\n"),
        fmt::format("s.toml:3: hierarchy.{} without a hierarchy, expected it removed, or hierarchy.culling = "
                    "\"off\" (every block) or \"blocks\"",
                    name));
    for (const std::string& with : {plane + "culling = \"off\"\n", plane + "culling = \"blocks\"\n", sphere})
      EXPECT_EQ(scene_error(with + key + (name == "surfels_per_pixel" ? "\nlevel = \"auto\"\n" : "\n")),
                "no error");
  }
  EXPECT_EQ(scene_error(sphere + "progressive = true\nculling = \"none\"\nblock_surfels = 64\n"),
            "s.toml:5: hierarchy.block_surfels, hierarchy.progressive without a hierarchy, expected them "
            "removed, or hierarchy.culling = \"off\" (every block) or \"blocks\"");
  EXPECT_EQ(scene_error(sphere + "surfels_per_pixel = 2\n"),
            "s.toml:3: hierarchy.surfels_per_pixel with level \"finest\", expected level = \"auto\"");
  EXPECT_EQ(scene_error(plane + "level = \"finest\"\nprogressive = false\n"), "no error");
}

TEST(Scene, KeysOfSurfelsHaveSomethingToActOn) {
  for (const std::string key : {"columns = 4", "rows = 4", "checker_square = 2", "checker_light = [1, 0, 0]",
                                "checker_dark = [1, 0, 0]"}) {
    EXPECT_EQ(scene_error("[surfels]\n" + key + "\n"), "no error");
    for (const char* other : {"generator = \"sphere\"\ncount = 20\n", "file = \"none.ply\"\n"})
      EXPECT_EQ(scene_error("[surfels]\n" + key + "\n" + other),
                fmt::format("s.toml:2: surfels.{} without the plane, expected it removed, or surfels with "
                            "generator = \"plane\" and no file",
                            key.substr(0, key.find(' '))));
  }
  for (const std::string key :
       {"count = 30", "pattern = \"checker\"", "pattern_scale = 0.5", "shading = 0.5"}) {
    EXPECT_EQ(scene_error("[surfels]\n\n" + key + "\n"),
              fmt::format("s.toml:3: surfels.{} without a mesh or a model, expected it removed, or surfels "
                          "with a file with faces or another generator than the plane",
                          key.substr(0, key.find(' '))));
  }
  for (const std::string key : {"mirror = true", "neighbours = 9"})
    EXPECT_EQ(scene_error("[surfels]\n" + key + "\n"),
              fmt::format("s.toml:2: surfels.{} without a file or a model, expected it removed, or surfels "
                          "with a file or another generator than the plane",
                          key.substr(0, key.find(' '))));
  const std::string sphere = "[surfels]\ngenerator = \"sphere\"\ncount = 20\n";
  EXPECT_EQ(scene_error(sphere + "pattern = \"zebra\"\npattern_scale = 0.5\nshading = 0\nmirror = true\n"),
            "no error");
  EXPECT_EQ(scene_error(sphere + "columns = 256\n"), "no error") << "its default";
  EXPECT_EQ(
      scene_error(sphere + "columns = 4\nrows = 4\n"),
      "s.toml:4: surfels.columns, surfels.rows without the plane, expected them removed, or surfels with "
      "generator = \"plane\" and no file");
  for (const std::string pattern : {"", "pattern = \"plain\"\n"})
    EXPECT_EQ(scene_error(sphere + "pattern_scale = 0.5\n" + pattern),
              "s.toml:4: surfels.pattern_scale without squares, stripes or spots, expected it removed, or "
              "another surfels.pattern");
  EXPECT_EQ(scene_error("[surfels]\nfile = \"none.ply\"\ngenerator = \"sphere\"\n"),
            "s.toml:3: surfels.generator beside surfels.file, expected one of them");
}

// Planes that a scene leaves open are put where its surfels begin and end.
TEST(Scene, APlaneIsNotBeyondWhatIsSeen) {
  const auto error = [](std::string_view camera) {
    return splatscope::error_of([&] {
      parse_scene(fmt::format("[surfels]\ngenerator = \"sphere\"\ncount = 50\n[camera]\n{}", camera),
                  "s.toml");
    });
  };
  EXPECT_EQ(error("near = 1\nfar = 50\n"), "no error");
  EXPECT_EQ(error("far = 5\nnear = 6\n"), "s.toml:6: camera.near is 6 and camera.far 5, expected near < far");
  EXPECT_EQ(error("\nnear = 60\n").find("s.toml:6: camera.near is 60, but what is to be seen ends "), 0u)
      << error("near = 60\n");
  EXPECT_EQ(error("far = 0.01\n").find("s.toml:5: camera.far is 0.01, but what is to be seen begins "), 0u);
  // All of one depth in binary64, but a pixel is wide there, and planes are as far apart as its filter.
  EXPECT_EQ(error("eye = [1e30, 0, 0]\ntarget = [-1e30, 0, 0]\n"), "no error");
}

TEST(Scene, CaptureBoxIsTheRightWayRound) {
  EXPECT_EQ(scene_error("\n[capture]\nbox_min = [0, 1, 0]\nbox_max = [1, 0, 1]\n"),
            "s.toml:3: capture.box_min exceeds capture.box_max, expected min <= max in x, y and z");
  EXPECT_EQ(scene_error("[capture]\nbox_min = [0, 0, 0]\nbox_max = [0, 0, 0]\n"), "no error");
}

TEST(Scene, WrongTomlIsTheUsersErrorWithItsLine) {
  EXPECT_EQ(scene_error("[frame]\nwidth = \n").find("s.toml:2: "), 0u) << scene_error("[frame]\nwidth = \n");
  EXPECT_EQ(scene_error("[frame]\nwidth = 1\nwidth = 2\n").find("s.toml:3: "), 0u);
  EXPECT_EQ(scene_error(std::string(100000, '[')).find("s.toml:1: "), 0u);
}

TEST(Scene, ReadyScenesAreTheThreeAlgorithms) {
  EXPECT_EQ(load_scene("checkerboard-no-ewa").splatting.algorithm, Algorithm::no_ewa);
  EXPECT_EQ(load_scene("checkerboard-ewa-per-pixel").splatting.algorithm, Algorithm::ewa_per_pixel);
  EXPECT_EQ(load_scene("checkerboard-ewa-per-surfel.toml").splatting.algorithm, Algorithm::ewa_per_surfel);
  EXPECT_THROW(load_scene("checkerboard-no-such"), UserError);
}

TEST(SceneKeys, DefaultsKeepTheirOwnRanges) {
  std::string text, table;
  for (const SceneKey& key : scene_keys()) {
    if (key.table == "volume") continue;  // a scene of its own: volume_scene_test
    if (key.table != table) text += fmt::format("[{}]\n", table = key.table);
    text += fmt::format("{} = {}\n", key.name, default_text(key));
  }
  EXPECT_EQ(scene_error(text), "no error") << text;
}

}  // namespace
}  // namespace splatscope::traces
