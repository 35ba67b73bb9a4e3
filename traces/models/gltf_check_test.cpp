#include "traces/models/gltf_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "model/testing/scratch_folder.h"

namespace splatscope::traces {
namespace {

// What of a glTF file the check looks at; component types of positions, normals and texture coordinates.
std::string gltf(int positions, int normals, int texcoords, std::string_view more = "") {
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "meshes": [{{"primitives": [{{}}, {{"attributes":
      {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_1": 2, "COLOR_0": 3}}}}]}}], "accessors": [{{"componentType": {}}},
      {{"componentType": {}}}, {{"componentType": {}}}, {{"componentType": 5121}}]{}}})",
      positions, normals, texcoords, more);
}

std::string error_in(const std::string& text) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.file("m.gltf", text);
  return folder.error_of([&] { expect_plain_gltf(file); });
}

TEST(GltfCheck, CoordinatesAreFloats) {
  EXPECT_EQ(error_in(gltf(5126, 5126, 5126)), "no error");
  EXPECT_EQ(error_in(gltf(5122, 5126, 5126)),
            "m.gltf: holds POSITION in integers, expected floats (componentType 5126)");
  EXPECT_EQ(error_in(gltf(5126, 5120, 5126)),
            "m.gltf: holds NORMAL in integers, expected floats (componentType 5126)");
  EXPECT_EQ(error_in(gltf(5126, 5126, 5123)),
            "m.gltf: holds TEXCOORD_1 in integers, expected floats (componentType 5126)");
}

TEST(GltfCheck, RequiredExtensionsAreOnesThatAMeshDoesWithout) {
  EXPECT_EQ(error_in(gltf(5126, 5126, 5126, R"(, "extensionsRequired": ["KHR_materials_unlit"])")),
            "no error");
  EXPECT_EQ(error_in(gltf(5126, 5126, 5126, R"(, "extensionsUsed": ["KHR_texture_transform"])")), "no error");
  EXPECT_EQ(error_in(gltf(5126, 5126, 5126, R"(, "extensionsRequired": ["KHR_mesh_quantization"])")),
            "m.gltf: requires the extension \"KHR_mesh_quantization\", expected a mesh that can be read "
            "without it");
}

TEST(GltfCheck, ABinaryFileIsLookedAtToo) {
  const std::string text = gltf(5122, 5126, 5126);
  std::string file = "glTF";
  for (const std::size_t word : {std::size_t{2}, 20 + text.size() + 8, text.size()})
    for (int byte = 0; byte < 4; ++byte) file.push_back(static_cast<char>(word >> 8 * byte & 0xff));
  file += "JSON" + text;
  EXPECT_EQ(error_in(file + std::string("\x04\0\0\0BIN\0data", 12)),
            "m.gltf: holds POSITION in integers, expected floats (componentType 5126)");
}

// assimp's to refuse, in words of its own.
TEST(GltfCheck, WhatIsNoGltfPasses) {
  for (const char* text : {"", "glTF", "[1]", "{", R"({"meshes": 3})", R"({"meshes": [[]], "accessors": {}})",
                           R"({"meshes": {"a": {"primitives": [{"attributes": {"POSITION": "b"}}]}}})",
                           R"({"meshes": [{"primitives": [{"attributes": {"POSITION": 7}}]}]})",
                           R"({"meshes": [{"primitives": [{"attributes": {"POSITION": -1}}]}]})",
                           R"({"extensionsRequired": [3, null, "KHR_lights_punctual"]})"})
    EXPECT_EQ(error_in(text), "no error") << text;
}

}  // namespace
}  // namespace splatscope::traces
