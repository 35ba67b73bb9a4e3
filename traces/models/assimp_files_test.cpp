#include "traces/models/assimp_files.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <string>

#include "model/testing/scratch_folder.h"
#include "traces/models/mesh_file.h"

namespace splatscope::traces {
namespace {

TEST(AssimpFiles, NamesAreTakenAsTheyStandOrAsUris) {
  const ScratchFolder folder;
  const std::filesystem::path at = folder.file("a", "").parent_path();
  folder.file("my skin.png", "");
  folder.file("100%25.png", "");
  folder.file("100%.png", "");
  std::filesystem::create_directory(at / "sub");
  folder.file("sub/x.mtl", "");
  EXPECT_EQ(file_named("my skin.png", at), at / "my skin.png");
  EXPECT_EQ(file_named("my%20skin.png", at), at / "my skin.png");
  EXPECT_EQ(file_named("%6dy%20s%6Bin.png", at), at / "my skin.png");
  EXPECT_EQ(file_named("100%25.png", at), at / "100%25.png");
  EXPECT_EQ(file_named("100%.png", at), at / "100%.png");
  EXPECT_EQ(file_named("sub\\x.mtl", at), at / "sub/x.mtl");
  for (const char* missing : {"no%20skin.png", "%", "%2", "%zz", "%-1.png"})
    EXPECT_EQ(file_named(missing, at), at / missing);
}

// The folder's own name is no URI.
TEST(AssimpFiles, ABufferOfGltfIsFoundByItsUri) {
  const ScratchFolder folder;
  const std::filesystem::path at = folder.file("a", "").parent_path() / "50%20off";
  std::filesystem::create_directory(at);
  std::string positions;
  for (const float number : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f})
    for (unsigned byte = 0; byte < 4; ++byte)
      positions += static_cast<char>(std::bit_cast<unsigned>(number) >> 8 * byte & 0xffu);
  folder.file("50%20off/my mesh.bin", positions);
  const MeshFile mesh = read_mesh(folder.file("50%20off/m.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"uri": "my%20mesh.bin", "byteLength": 36}]})"));
  ASSERT_EQ(mesh.model.mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.model.mesh.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.files.back(), at / "my mesh.bin");
}

}  // namespace
}  // namespace splatscope::traces
