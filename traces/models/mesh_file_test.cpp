#include "traces/models/mesh_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "model/error.h"
#include "model/testing/scratch_folder.h"
#include "traces/point_file.h"
#include "traces/scene.h"
#include "traces/surfels.h"

namespace splatscope::traces {
namespace {

class MeshFileTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, std::string_view text) const {
    return folder_.file(name, text);
  }
  Scene scene_of(const std::string& name, std::string_view text,
                 std::string_view keys = "count = 50\n") const {
    file(name, text);
    return parse_scene(fmt::format("[surfels]\nfile = \"{}\"\n{}", name, keys), folder_ / "s.toml");
  }
  std::string error_of(const std::string& name, std::string_view text) const {
    return folder_.error_of([&] { scene_of(name, text); });
  }

  ScratchFolder folder_;
};

constexpr std::string_view kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

// Whether a file holds points is known when it is looked at.
TEST_F(MeshFileTest, PointsHaveNoUseForKeysOfAMesh) {
  constexpr std::string_view kPoints =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n";
  EXPECT_EQ(scene_of("points.ply", kPoints, "mirror = true\nneighbours = 4\n").surfels.size(), 2u);
  for (const std::string_view key : {"count = 3", "pattern = \"checker\"", "shading = 0"}) {
    EXPECT_EQ(folder_.error_of([&] { scene_of("points.ply", kPoints, key); }),
              fmt::format("s.toml:3: surfels.{} without a mesh or a model, expected it removed, or surfels "
                          "with a file with faces or another generator than the plane",
                          key.substr(0, key.find(' '))));
  }
}

TEST_F(MeshFileTest, PolygonsBecomeSurfels) {
  const Scene scene = scene_of("square.obj", kSquare);
  EXPECT_EQ(scene.surfels.size(), 50u);
  EXPECT_EQ(scene.mesh.triangles, 2u);
  EXPECT_GT(scene.mesh.normals_computed, 0u);
  for (const Surfel& s : scene.surfels) {
    EXPECT_EQ(s.normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(s.position.z, 0);
    EXPECT_TRUE(s.position.x >= 0 && s.position.x <= 1 && s.position.y >= 0 && s.position.y <= 1);
  }
}

// Near 1000 binary32 has steps of 6e-5.
constexpr std::string_view kTiny =
    "v 1000 1000 1000\nv 1000.0005 1000 1000\nv 1000 1000.0005 1000\nf 1 2 3\n";

TEST_F(MeshFileTest, WhatFindsNoPlaceIsCounted) {
  const Scene scene = scene_of("tiny.obj", kTiny, "count = 1000\n");
  EXPECT_EQ(scene.surfels.size(), 45u);
  EXPECT_EQ(scene.skipped.duplicate, 955u);
  SurfelSource source = default_settings().surfels;
  source.file = "tiny.obj";
  source.count = 1000;
  const SampledModel sampled = sample_source(source, folder_.path());
  EXPECT_EQ(describe(sampled),
            "1000 surfels from 1 triangles, 3 normals computed, 955 at the place of another");
  for (const Surfel& s : sampled.surfels) ASSERT_GT(s.radius, 8e-5f) << "a step and more";
  EXPECT_EQ(describe(SampledModel{{}, {.triangles = 2}, 0, 3}), "0 surfels from 2 triangles, 3 of radius 0");
}

TEST_F(MeshFileTest, ASurfelAloneIsAsLargeAsTheMesh) {
  for (const std::string_view square :
       {kSquare, std::string_view("v 5 7 2\nv 6 7 2\nv 6 8 2\nv 5 8 2\nf 1 2 3 4\n")}) {
    const Scene scene = scene_of("square.obj", square, "count = 1\n");
    ASSERT_EQ(scene.surfels.size(), 1u);
    EXPECT_NEAR(scene.surfels[0].radius, std::sqrt(1 / std::numbers::pi), 1e-6);
  }
  EXPECT_EQ(parse_scene("[surfels]\ngenerator = \"sphere\"\ncount = 1\n", "s.toml").surfels.size(), 1u);
}

TEST_F(MeshFileTest, APlyWithFacesIsAMeshAndOneWithoutIsPoints) {
  const std::string_view head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string_view vertices = "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n";
  const Scene mesh = scene_of(
      "m.ply",
      fmt::format("{}element face 1\nproperty list uchar int vertex_indices\nend_header\n{}3 0 1 2\n", head,
                  vertices),
      "count = 50\nshading = 0\n");
  ASSERT_EQ(mesh.surfels.size(), 50u);
  EXPECT_EQ(mesh.surfels[0].color, glm::vec3(1, 0, 0)) << "the vertices' colour";
  const Scene points = scene_of("p.ply", fmt::format("{}end_header\n{}", head, vertices), "");
  EXPECT_EQ(points.surfels.size(), 3u);
  EXPECT_EQ(points.mesh.triangles, 0u);
  const std::string strips =
      fmt::format("{}element tristrips 1\nproperty list uchar int vertex_indices\nend_header\n{}3 0 1 2\n",
                  head, vertices);
  EXPECT_NE(error_of("s.ply", strips).find("holds triangle strips, expected"), std::string::npos);
  for (const auto& [type, is_read] : {std::pair{"uchar", true},
                                      {"ushort", true},
                                      {"float", true},
                                      {"double", true},
                                      {"char", false},
                                      {"short", false},
                                      {"int", false},
                                      {"uint", false}}) {
    const std::string faces = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty {0} red\nproperty {0} green\nproperty {0} blue\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n"
        "3 0 1 2\n",
        type);
    const bool refused = error_of("c.ply", faces).find("none that colours of a mesh") != std::string::npos;
    EXPECT_EQ(refused, !is_read) << type;
  }
}

TEST_F(MeshFileTest, AByteOrderMarkIsPassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(scene_of("square.obj", mark + std::string(kSquare)).mesh.triangles, 2u);
  const std::string_view ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(scene_of("m.ply", mark + std::string(ply)).mesh.triangles, 1u);
  file("red.MTL", mark + "newmtl red\nKd 1 0 0\n");
  const Scene red = scene_of("red.OBJ", mark + "mtllib red.MTL\nusemtl red\n" + std::string(kSquare),
                             "count = 50\nshading = 0\n");
  ASSERT_EQ(red.surfels.size(), 50u);
  EXPECT_EQ(red.surfels[0].color, glm::vec3(1, 0, 0));
}

TEST_F(MeshFileTest, ABinaryFileMayBeginLikeAByteOrderMark) {
  std::string buffer("\xEF\xBB\xBF\0", 4);  // passed over by the view of it
  for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    buffer.append(reinterpret_cast<const char*>(&number), sizeof(number));
  file("m.bin", buffer);
  const Scene scene =
      scene_of("m.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteOffset": 4, "byteLength": 36}],
    "buffers": [{"uri": "m.bin", "byteLength": 40}]})");
  EXPECT_EQ(scene.mesh.triangles, 1u);
  for (const Surfel& s : scene.surfels) EXPECT_EQ(s.normal, glm::vec3(0, 0, 1));
}

// 2 x 2 texels: red, green above, blue, white below. Each corner of the square has one of them.
TEST_F(MeshFileTest, ColoursComeFromTheTexture) {
  file("t.ppm", std::string_view("P6\n2 2\n255\n\xff\0\0\0\xff\0\0\0\xff\xff\xff\xff", 23));
  file("m.mtl", "newmtl skin\nKd 0.5 0.5 0.5\nmap_Kd t.ppm\n");
  const std::string mesh =
      "mtllib m.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 "
      "2/2 3/3 4/4\n";
  const Scene scene = scene_of("m.obj", mesh, "count = 400\nshading = 0\n");
  EXPECT_EQ(scene.mesh.textures_unreadable, 0u);
  std::size_t looked_at = 0;
  for (const Surfel& s : scene.surfels) {
    const glm::vec2 off = glm::abs(glm::vec2(s.position.x, s.position.y) - 0.5f);
    if (std::abs(off.x - 0.25f) > 0.06f || std::abs(off.y - 0.25f) > 0.06f) continue;
    ++looked_at;
    const bool right = s.position.x > 0.5f, top = s.position.y > 0.5f;
    const glm::vec3 texel = top ? (right ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0))
                                : (right ? glm::vec3(1, 1, 1) : glm::vec3(0, 0, 1));
    // At 0.12 texels off the centre each way the others mix in by at most 1 - 0.88^2 = 0.226.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(s.color[i], texel[i], 0.25) << s.position.x << ' ' << s.position.y;
  }
  EXPECT_GT(looked_at, 4u);
  std::filesystem::remove(folder_ / "t.ppm");
  const Scene without = scene_of("m.obj", mesh, "count = 10\nshading = 0\n");
  EXPECT_EQ(without.mesh.textures_unreadable, 1u);
  EXPECT_EQ(without.surfels[0].color, glm::vec3(0.5f)) << "the material's colour stands in";
}

// Red of alpha 64, in a Targa file of 32 bits.
TEST_F(MeshFileTest, ColoursOfATextureAreNotMultipliedByItsAlpha) {
  file("t.tga", std::string_view("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x28\0\0\xff\x40", 22));
  file("m.mtl", "newmtl skin\nmap_Kd t.tga \n");
  const Scene scene = scene_of("m.obj",
                               "mtllib m.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\n"
                               "f 1/1 2/1 3/1\n",
                               "count = 10\nshading = 0\n");
  for (const Surfel& s : scene.surfels) EXPECT_EQ(s.color, glm::vec3(1, 0, 0));
}

// The same in a file of its own within a mesh: a PNG of one texel.
TEST_F(MeshFileTest, ATextureMayBeInTheMeshsOwnFile) {
  const Scene scene = scene_of("m.gltf",
                               R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"material": 0,
      "attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}], "images": [{"uri": "data:image/png;base64,)"
                               "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
                               "DUlEQVR4nGP4z8DgAAAEQQFAjv0/EgAAAABJRU5ErkJggg=="
                               R"("}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
    "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
                               "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAA"
                               "gD8AAAAAAAAAPwAAAD8AAAA/AAAAPwAAAD8AAAA/"
                               R"("}]})",
                               "count = 10\nshading = 0\n");
  EXPECT_EQ(scene.mesh.textures_unreadable, 0u);
  for (const Surfel& s : scene.surfels) EXPECT_EQ(s.color, glm::vec3(1, 0, 0));
}

// Each part by itself: a texture needs places in it, and colours of another part are none of its own.
TEST_F(MeshFileTest, PartsHaveColoursOfTheirOwn) {
  file("t.ppm", std::string_view("P6\n1 1\n255\n\xff\0\0", 14));
  file("m.mtl", "newmtl skin\nKd 0 1 0\nmap_Kd t.ppm\n");
  const std::string quads =
      "mtllib m.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\n"
      "vt 0 0\no a\nf 1/1 2/1 3/1 4/1\no b\nf 5 6 7 8\n";
  const Scene scene = scene_of("m.obj", quads, "count = 100\nshading = 0\n");
  for (const Surfel& s : scene.surfels)
    EXPECT_EQ(s.color, s.position.x < 1.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)) << s.position.x;
  const std::string mixed = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nf 1 2 3\n";
  EXPECT_NE(error_of("c.obj", mixed).find("c.obj:3: vertices with colours beside ones without"),
            std::string::npos)
      << "assimp makes the third black";
}

TEST_F(MeshFileTest, AMirroredNodeKeepsItsFaces) {
  std::string buffer;
  for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    buffer.append(reinterpret_cast<const char*>(&number), sizeof(number));
  file("m.bin", buffer);
  for (const char* scale : {"1", "-1"}) {
    const Scene scene = scene_of("m.gltf", fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0,
      "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0, "scale": [{}, 1, 1]}}],
      "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
      "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 1, 0]}}],
      "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "buffers": [{{"uri": "m.bin", "byteLength": 36}}]}})",
                                                       scale));
    for (const Surfel& s : scene.surfels) EXPECT_EQ(s.normal, glm::vec3(0, 0, 1)) << scale;
  }
}

// A material says which of a part's layouts its texture goes by: red in the first, blue in the second.
TEST_F(MeshFileTest, ATextureGoesByTheLayoutThatItsMaterialNames) {
  file("t.ppm", std::string_view("P6\n2 1\n255\n\xff\0\0\0\0\xff", 17));
  std::string buffer;
  for (const float number : {0.f,   0.f,  0.f,   1.f,  0.f,   0.f,  0.f,   1.f,  0.f,   0.25f, 0.5f,
                             0.25f, 0.5f, 0.25f, 0.5f, 0.75f, 0.5f, 0.75f, 0.5f, 0.75f, 0.5f})
    buffer.append(reinterpret_cast<const char*>(&number), sizeof(number));
  file("m.bin", buffer);
  for (const int set : {0, 1}) {
    const Scene scene = scene_of("m.gltf",
                                 fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0,
      "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"material": 0,
        "attributes": {{"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}}}}]}}],
      "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, "texCoord": {}}}}}}}],
      "textures": [{{"source": 0}}], "images": [{{"uri": "t.ppm"}}],
      "accessors": [
        {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
          "max": [1, 1, 0]}},
        {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}},
        {{"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"}}],
      "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 24}},
                      {{"buffer": 0, "byteOffset": 60, "byteLength": 24}}],
      "buffers": [{{"uri": "m.bin", "byteLength": 84}}]}})",
                                             set),
                                 "count = 10\nshading = 0\n");
    for (const Surfel& s : scene.surfels)
      EXPECT_LT(glm::distance(s.color, set == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1)), 1e-6f) << set;
  }
}

TEST_F(MeshFileTest, FilesOfMaterialsThatAreMissingAreCounted) {
  file("here.mtl", "newmtl red\nKd 1 0 0\n");
  const auto missing = [&](const char* mesh, const std::string& libraries) {
    const Scene scene = scene_of(mesh, libraries + std::string(kSquare), "count = 4\nshading = 0\n");
    return scene.mesh.materials_unreadable;
  };
  EXPECT_EQ(missing("m.obj", ""), 0u);
  EXPECT_EQ(missing("m.obj", "mtllib here.mtl\n"), 0u);
  EXPECT_EQ(missing("m.obj", "mtllib gone.mtl\n"), 1u);
  EXPECT_EQ(missing("m.obj", "mtllib m.mtl\n"), 1u);
  EXPECT_EQ(missing("m.obj", "mtllib gone.mtl\nmtllib here.mtl\nmtllib lost.mtl\n"), 2u);
  std::filesystem::create_directory(folder_ / "sub");
  file("sub/other.mtl", "newmtl blue\nKd 0 0 1\n");
  EXPECT_EQ(missing("m.obj", "mtllib sub\\other.mtl\n"), 0u) << "as Windows writes it";
  EXPECT_EQ(missing("here.obj", "mtllib gone.mtl\n"), 1u) << "assimp takes here.mtl for it";
}

TEST_F(MeshFileTest, PatternsAreFunctionsOfThePlace) {
  const Scene scene = scene_of("square.obj", kSquare,
                               "count = 300\npattern = \"stripes\"\npattern_scale = 0.3\nshading = 0\n");
  std::vector<glm::vec3> colors;
  for (const Surfel& s : scene.surfels) colors.push_back(s.color);
  for (std::size_t i = 1; i < colors.size(); ++i)
    EXPECT_TRUE(scene.surfels[i].position.y != scene.surfels[0].position.y || colors[i] == colors[0]);
  std::ranges::sort(colors, {}, [](const glm::vec3& c) { return c.y; });
  EXPECT_NE(colors.front(), colors.back());
}

TEST_F(MeshFileTest, BrokenTrianglesAreCounted) {
  const Scene scene =
      scene_of("broken.ply",
               "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
               "property float z\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n1 1 0\nnan 0 0\n2 0 0\n0 1 0\n"
               "3 0 1 2\n3 0 1 4\n3 0 1 3\n3 0 1 77\n3 0 2 5\n");
  EXPECT_EQ(scene.surfels.size(), 50u);
  EXPECT_EQ(scene.mesh.triangles, 2u);
  EXPECT_EQ(scene.mesh.triangles_degenerate, 1u);
  EXPECT_EQ(scene.mesh.triangles_not_finite, 1u);
  EXPECT_EQ(scene.mesh.triangles_out_of_range, 1u);
}

TEST_F(MeshFileTest, WhatIsNoMeshIsTheUsersError) {
  EXPECT_NE(error_of("x.obj", "v 0 0 0\nv 1 0 0\n").find("x.obj: "), std::string::npos);
  EXPECT_NE(error_of("x.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
                .find("no triangle of it has a surface: 1 left out (1 without area)"),
            std::string::npos);
  EXPECT_NE(error_of("x.nonsense", "1").find("no ending that assimp knows"), std::string::npos);
  EXPECT_NE(error_of("x.stl", "").find("x.stl: "), std::string::npos);
  EXPECT_NE(error_of("x.off", "OFF\n4000000000 4000000000 0\n0 0 0\n").find("do not fit"), std::string::npos);
  EXPECT_NE(
      error_of(
          "x.ply",
          "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
          "property float z\nelement face 4000000000\nproperty list uchar int vertex_indices\nend_header\n")
          .find("do not fit"),
      std::string::npos);
  EXPECT_THROW(read_mesh(folder_ / "none.obj"), UserError);
  EXPECT_THROW(read_mesh(folder_.path()), UserError);
}

std::string ply_mesh(std::string_view format, std::string_view faces, std::string_view data) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list int int vertex_indices\nend_header\n{}",
      format, faces, data);
}

TEST_F(MeshFileTest, AnAsciiPlyIsWhatItsHeaderSays) {
  const auto error = [&](std::string_view faces, std::string_view data) {
    return error_of("x.ply", ply_mesh("ascii", faces, data));
  };
  EXPECT_EQ(scene_of("x.ply", ply_mesh("ascii", "1", "0 0 0\n1 0 0\n0 1 0\n\n3 0 1 2\n")).mesh.triangles, 1u);
  EXPECT_EQ(error("3", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            "x.ply:14: the file ends within its data, expected a number");
  EXPECT_EQ(error("1", "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "x.ply:11: 2 numbers, expected 3");
  EXPECT_EQ(error("1", "0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n"), "x.ply:11: 4 numbers, expected 3");
  EXPECT_EQ(error("1", "0 0 0\n1 0 0\n0 1.0.0 0\n3 0 1 2\n"),
            "x.ply:12: \"1.0.0\" is no number, expected a number");
  EXPECT_EQ(error("1", "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), "x.ply:13: 3 numbers, expected more");
  EXPECT_EQ(error("1", "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"),
            "x.ply:13: a list of -3 items, expected 0 or more");
  EXPECT_EQ(error("1", "0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n"), "x.ply:13: 4 numbers, expected more");
  EXPECT_EQ(error("1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n"),
            "x.ply:14: a line more than the header counts, expected the end of the file");
}

TEST_F(MeshFileTest, ABinaryPlyIsWhatItsHeaderSays) {
  const auto with_list_of = [](int count) {
    std::string data;
    const auto add = [&](auto value) { data.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) add(number);
    for (const int number : {count, 0, 1, 2}) add(number);
    return ply_mesh("binary_little_endian", "1", data);
  };
  const std::string whole = with_list_of(3);
  EXPECT_EQ(scene_of("x.ply", whole).mesh.triangles, 1u);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(error_of("x.ply", whole.substr(0, size)), "no error") << size << " bytes of " << whole.size();
  const auto error = [&](int count) { return error_of("x.ply", with_list_of(count)); };
  EXPECT_EQ(error(-3),
            fmt::format("x.ply: a list of -3 items at byte {}, expected 0 or more", whole.size() - 12));
  for (const int count : {4, 2000000000})
    EXPECT_EQ(error(count),
              fmt::format("x.ply: the file ends within its data at byte {}, expected {} values of 4 bytes",
                          whole.size() - 12, count));
}

// Nested so deep that assimp's reader overflows its stack.
TEST_F(MeshFileTest, AReaderThatBreaksDownIsAUsersError) {
  const std::string deep(200000, '['), back(200000, ']');
  EXPECT_EQ(error_of("x.gltf", R"({"asset":{"version":"2.0","extras":)" + deep + back + "}}")
                .find("x.gltf: its reader breaks down,"),
            0u);
}

TEST_F(MeshFileTest, AnOffFileIsWhatItsHeaderSays) {
  const std::string rows = "0 0 0\n1 0 0\n\n0 1 0 # a corner\n3 0 1 2\n";
  for (const char* header : {"OFF\n3 1 0\n", "OFF 3 1 0\n# made by hand\n\n", "3 1 0\n", "nOFF 3\n3 1 0\n"})
    EXPECT_EQ(scene_of("x.off", header + rows + "\n# the end\n").mesh.triangles, 1u) << header;
  EXPECT_EQ(
      scene_of("x.off", "COFF\r\n3 1 0\r\n0 0 0 255 0 0 1\r\n1 0 0 9 9 9 9\r\n0 1 0 9 9 9 9\r\n3 0 1 2\r\n")
          .mesh.triangles,
      1u);
  const auto error = [&](std::string_view text) { return error_of("x.off", text); };
  EXPECT_EQ(error("OFF\n3 2 0\n" + rows),
            "x.off:7: the file ends within its data, expected a line of numbers");
  EXPECT_EQ(error("OFF\n3 0 0\n" + rows),
            "x.off:7: a line more than the header counts, expected the end of the file");
  EXPECT_EQ(error("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "x.off:4: 2 numbers, expected 3 or more");
  EXPECT_EQ(error("NOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "x.off:3: 3 numbers, expected 6 or more");
  EXPECT_EQ(error("OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n"),
            "x.off:4: \"x\" is no number, expected a number");
  const std::string vertices = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(error(vertices + "3 0 1"), "x.off:7: 3 numbers, expected 4 or more");
  EXPECT_EQ(error(vertices + "3 0 -1 2"), "x.off:7: \"-1\" is no vertex, expected a whole number from 0 on");
  EXPECT_EQ(error(vertices + "10 0 1 2 0 1 2 0 1 2 0"),
            "x.off:7: a face of \"10\" corners, expected 1 to 9, as assimp does");
  for (const char* line : {" \n", "# the last\n"})
    EXPECT_EQ(error(vertices + line + "3 0 2 1\n"),
              "x.off:7: blanks or a comment between the rows, expected a line of numbers");
  EXPECT_EQ(error("CNOFF\n3 1 0\n" + rows),
            "x.off:1: colours beside normals, which assimp reads one number off, expected one of them");
  EXPECT_EQ(error("off\n3 1 0\n" + rows), "x.off:1: the first word is not \"OFF\", expected an OFF file");
  EXPECT_EQ(error("nOFF 4\n3 1 0\n" + rows), "x.off:1: a wrong number of dimensions, expected 1 to 3");
}

// assimp's reader drops a vertex with such a number, and later indices are of the next one.
TEST_F(MeshFileTest, NumbersOfAnObjFileMayBeginWithAPoint) {
  const auto largest = [&](std::string_view text) {
    glm::vec3 corner(-1e9f);
    for (const Surfel& s : scene_of("x.obj", text).surfels) corner = glm::max(corner, s.position);
    return corner;
  };
  const std::string faces = "v 0 1 0\nv 5 5 5\nf 1 3 4\n";
  const glm::vec3 expected = largest("v 0 0 0\nv 9 0.5 0\nv 1 0 0\n" + faces);
  EXPECT_LE(expected.z, 1);
  for (const char* number : {".5", "+.5", "-.5", "nan", "inf", "\\\n.5", "\\\r\n.5"})
    EXPECT_EQ(largest(fmt::format("v 0 0 0\n  v 9 {} 0 # .5\nv 1 0 0\n{}", number, faces)), expected)
        << number;
  EXPECT_EQ(largest("\xEF\xBB\xBFv .0 .0 .0 .5\r\nv\t9 .5 .0\r\nv 1 .0 .0 1.\r\n" + faces), expected);
  const std::string color = " .1 .2 .3\n";
  EXPECT_EQ(largest("v 0 0 0" + color + "v 9 .5 0" + color + "v 1 0 0" + color + "v 0 1 0" + color +
                    "v 5 5 5" + color + "f 1 3 4\n"),
            expected);
  EXPECT_EQ(largest("v 0 0 0\rv 9 .5 0\rv 1 0 0\r" + faces), expected);
  EXPECT_EQ(largest("v 0 0 0\nv 2 .5 0\nv 2 0 0\nvt .1 .2\nvn .0 0 1\nf 1/1/1 2/1/1 3/1/1\n"),
            largest("v 0 0 0\nv 2 0.5 0\nv 2 0 0\nf 1 2 3\n"));
  EXPECT_EQ(
      scene_of("x.obj", "v 0 0 0\nv 1 nan 0\nv 1 0 0\nv 0 1 0\nf 1 3 4\nf 1 2 4\n").mesh.triangles_not_finite,
      1u);
}

TEST_F(MeshFileTest, AVertexOfAnObjFileHasItsNumbers) {
  const auto error = [&](std::string_view vertex) {
    return error_of("x.obj", fmt::format("v 0 0 0\n{}\n{}", vertex, kSquare));
  };
  EXPECT_EQ(error("v 9 1"), "x.obj:2: a vertex of 2 numbers, expected 3, 4 or 6");
  EXPECT_EQ(error("v 1 \\\n2"), "x.obj:3: a vertex of 2 numbers, expected 3, 4 or 6");
  EXPECT_EQ(error("v 1 1 1 1 1 1 1"), "x.obj:2: a vertex of 7 numbers, expected 3, 4 or 6");
  EXPECT_EQ(error("v 1 one 1"), "x.obj:2: \"one\" is no number, expected a number");
  EXPECT_EQ(error("vt . 1"), "x.obj:2: \".\" is no number, expected a number");
}

// Every beginning of a good file: an error or a picture of what there is, never a crash.
TEST_F(MeshFileTest, TruncatedFilesAreHarmless) {
  const std::string_view off = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
  for (const auto& [name, text] : {std::pair("x.obj", kSquare), std::pair("x.off", off)}) {
    std::size_t wrong = 0;
    for (std::size_t size = 0; size < text.size(); ++size)
      wrong += error_of(name, text.substr(0, size)) != "no error";
    EXPECT_GT(wrong, text.size() / 3) << name;
  }
}

TEST_F(MeshFileTest, WrittenSurfelsAreReadBack) {
  const Scene scene = scene_of("square.obj", kSquare);
  write_ply(scene.surfels, folder_ / "out.ply");
  const PointFile read = read_ply(folder_ / "out.ply");
  EXPECT_TRUE(read.has_normals && read.has_radii);
  ASSERT_EQ(read.surfels.size(), scene.surfels.size());
  for (std::size_t i = 0; i < read.surfels.size(); ++i) {
    EXPECT_EQ(read.surfels[i].position, scene.surfels[i].position);
    EXPECT_EQ(read.surfels[i].normal, scene.surfels[i].normal);
    EXPECT_EQ(read.surfels[i].radius, scene.surfels[i].radius);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(read.surfels[i].color[c], scene.surfels[i].color[c], 0.5 / 255 + 1e-6);
  }
}

}  // namespace
}  // namespace splatscope::traces
