#include "traces/volumes/volume_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/error.h"
#include "traces/scene.h"
#include "traces/scene_keys.h"

namespace splatscope::traces {
namespace {

std::string error_of(const std::string& text) {
  try {
    parse_volume_scene(text, "a.toml");
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

TEST(VolumeScene, EveryKeyHasADefault) {
  const VolumeScene scene = parse_volume_scene("[volume]\n", "a.toml");
  EXPECT_EQ(scene.volume.size, glm::ivec3(64));
  EXPECT_EQ(scene.settings.cutoff, kernels::VolumeSettings{}.cutoff);
  EXPECT_GT(scene.flattening.low, scene.flattening.high);
  EXPECT_EQ(scene.view.width, 512);
  // The camera frames the volume: its corners are in the picture.
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 camera = scene.view.camera_space(0.5 * side * scene.volume.extent());
    EXPECT_GT(camera.z, scene.view.near_plane);
    const glm::dvec2 x = scene.view.window(camera);
    EXPECT_TRUE(x.x > 0 && x.x < 512 && x.y > 0 && x.y < 512);
  }
}

TEST(VolumeScene, DefaultsKeepTheirOwnRanges) {
  std::string text = "[volume]\n";
  for (const SceneKey& key : volume_keys()) text += fmt::format("{} = {}\n", key.name, default_text(key));
  EXPECT_EQ(error_of(text), "no error") << text;
}

TEST(VolumeScene, ReadsItsKeys) {
  const VolumeScene scene = parse_volume_scene(R"([volume]
generator = "head"
voxels = [16, 20, 8]
transfer = [
  { value = 0.2, opacity = 0, color = [1, 0, 0] },
  { value = 0.8, opacity = 0.5, color = [0, 0, 1] },
]
surface_low = 0.7
surface_high = 2
prefilter = "swan"
light = [0, 1, 0]
[frame]
width = 64
)",
                                               "a.toml");
  EXPECT_EQ(scene.volume.size, glm::ivec3(16, 20, 8));
  EXPECT_DOUBLE_EQ(scene.transfer(0.5).opacity, 0.25);
  EXPECT_NEAR(scene.transfer(0.5).color.b, 0.5, 1e-12);
  EXPECT_EQ(scene.flattening.low, 0.7);
  EXPECT_EQ(scene.settings.prefilter, kernels::VolumePrefilter::swan);
  EXPECT_EQ(scene.settings.light.toward_light, glm::dvec3(0, 1, 0));
  EXPECT_EQ(scene.view.width, 64);
  EXPECT_GT(scene.splats().splats.size(), 100u);
}

TEST(VolumeScene, SaysWhatIsWrong) {
  EXPECT_EQ(error_of("[surfels]\n"), "a.toml: has no [volume], expected a scene with a volume");
  EXPECT_EQ(error_of("[volume]\n[surfels]\n"),
            "a.toml:2: [surfels] beside [volume], expected [camera], [frame] and [volume] alone");
  EXPECT_EQ(
      error_of("[volume]\nvoxels = [4, 4, 5]\n"),
      "a.toml:1: volume.voxels is [4, 4, 5], expected whole numbers, at most 6.71089e+07 voxels, as many "
      "along each axis and at least 2");
  EXPECT_EQ(error_of("[volume]\nlight = [0, 0, 0]\n"),
            "a.toml:1: volume.light is zero, expected a direction");
  EXPECT_EQ(error_of("[volume]\nfile = \"none.nrrd\"\n"), "none.nrrd: cannot be read, expected a NRRD file");
  for (const char* points :
       {"[{ value = 1, opacity = 2, color = [0, 0, 0] }]", "[{ value = 1 }]", "3", "[3]",
        "[{ value = nan, opacity = 0, color = [0, 0, 0] }]",
        "[{ value = 2, opacity = 0, color = [0, 0, 0] }, { value = 1, opacity = 0, color = [0, 0, 0] }]"}) {
    const std::string text = error_of(std::string("[volume]\ntransfer = ") + points + "\n");
    EXPECT_TRUE(text.starts_with("a.toml:2: volume.transfer is ")) << text;
  }
}

TEST(VolumeScene, IsNoSceneOfSurfels) {
  try {
    parse_scene("\n[volume]\n", "a.toml");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(),
                 "a.toml:2: [volume] is drawn by `splatscope volume`, expected a scene of surfels");
  }
}

}  // namespace
}  // namespace splatscope::traces
