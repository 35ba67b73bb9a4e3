#include "traces/volumes/volume_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/testing/scratch_folder.h"
#include "traces/output_files.h"
#include "traces/scene.h"
#include "traces/scene_keys.h"
#include "traces/volume_trace.h"

namespace splatscope::traces {
namespace {

std::string volume_scene_error(const std::string& text) {
  return splatscope::error_of([&] { parse_volume_scene(text, "a.toml"); });
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
  EXPECT_EQ(volume_scene_error(text), "no error") << text;
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
  EXPECT_EQ(volume_scene_error("[surfels]\n"), "a.toml: has no [volume], expected a scene with a volume");
  EXPECT_EQ(volume_scene_error("[volume]\n[surfels]\n"),
            "a.toml:2: [surfels] beside [volume], expected [camera], [frame] and [volume] alone");
  EXPECT_EQ(
      volume_scene_error("[volume]\nvoxels = [4, 4, 5]\n"),
      "a.toml:2: volume.voxels is [4, 4, 5], expected three times the same whole number from 2 on, at most "
      "67108864 voxels in all, or three zeros");
  for (const char* wrong : {"[0, 0, 20]", "[1.5, 2, 3]", "[1024, 1024, 65]"})
    EXPECT_EQ(volume_scene_error(fmt::format("[volume]\ngenerator = \"head\"\nvoxels = {}\n", wrong)),
              fmt::format(
                  "a.toml:3: volume.voxels is {}, expected whole numbers from 1 on, at most 67108864 voxels "
                  "in all, or three zeros",
                  wrong));
  EXPECT_EQ(volume_scene_error("[volume]\nlight = [0, 0, 0]\n"),
            "a.toml:2: volume.light is zero, expected a direction");
  EXPECT_TRUE(volume_scene_error("[volume]\n[camera]\nnear = 60\n")
                  .starts_with("a.toml:3: camera.near is 60, but what is to be seen ends "));
  EXPECT_EQ(
      volume_scene_error("[volume]\n[camera]\neye = [1e30, 0, 0]\ntarget = [-1e30, 0, 0]\n"),
      "a.toml:3: seen from camera.eye [1e+30, 0, 0] toward camera.target [-1e+30, 0, 0] all has the same "
      "depth in binary64, expected an eye nearer to what is to be seen");
  EXPECT_EQ(volume_scene_error("[volume]\nfile = \"none.nrrd\"\n"),
            "none.nrrd: cannot be read, expected a NRRD file");
  for (const auto& [points, wrong] :
       {std::pair("[{ value = 1, opacity = 2, color = [0, 0, 0] }]", "2: volume.transfer[0] is { color = "),
        {"[{ value = 1 }]", "2: volume.transfer[0] is { value = 1 }, expected { value, opacity, "},
        {"3", "2: volume.transfer is 3, "},
        {"[3]", "2: volume.transfer[0] is 3, "},
        {"[{ value = nan, opacity = 0, color = [0, 0, 0] }]", "2: volume.transfer[0] is "},
        {"[{ value = 2, opacity = 0, color = [0, 0, 0] },\n{ value = 1, opacity = 0, color = [0, 0, 0] }]",
         "3: volume.transfer[1] is "}}) {
    const std::string text = volume_scene_error(fmt::format("[volume]\ntransfer = {}\n", points));
    EXPECT_TRUE(text.starts_with(fmt::format("a.toml:{}", wrong))) << text;
  }
}

// A cube of 5 x 4 x 3 voxels, one unit apart, as each kind of data set.
class VolumeKinds : public testing::Test {
 protected:
  VolumeKinds() {
    std::string nrrd =
        "NRRD0004\ntype: float\ndimension: 4\nsizes: 3 5 4 3\nencoding: raw\nendian: little\n\n";
    std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 60\nproperty float x\nproperty float y\nproperty float z\n"
        "property float radius\nproperty float value\nend_header\n";
    for (int i = 0; i < 60; ++i) {
      const int row = i / 5, layer = i / 20;
      const float place[] = {static_cast<float>(i % 5) - 2, static_cast<float>(row % 4) - 1.5f,
                             static_cast<float>(layer) - 1};
      nrrd.append(reinterpret_cast<const char*>(place), sizeof place);
      ply += fmt::format("{} {} {} 1 {}\n", place[0], place[1], place[2], i);
    }
    std::string values = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 5 4 3\nencoding: raw\n\n";
    for (int i = 0; i < 60; ++i) values += static_cast<char>(i);
    folder_.file("places.nrrd", nrrd);
    folder_.file("samples.ply", ply);
    folder_.file("values.nrrd", values);
  }

  VolumeScene scene(const std::string& keys, const std::string& eye = "[4, 5, 12]",
                    const std::string& target = "[0, 0, 0]") const {
    return parse_volume_scene(
        "[volume]\n" + keys +
            "transfer = [{ value = 10, opacity = 0, color = [1, 0, 0] }, { value = 50, opacity = 0.5, color "
            "= [0, 1, 1] "
            "}]\nambient = 1\ndiffuse = 0\nspecular = 0\n[frame]\nwidth = 40\nheight = 40\n[camera]\neye = " +
            eye + "\ntarget = " + target + "\nup = [0, 1, 0]\nfov_y_degrees = 35\nnear = 1\nfar = 40\n",
        folder_ / "s.toml");
  }
  std::string error(const std::string& keys) const {
    return folder_.error_of([&] { scene(keys); });
  }

  ScratchFolder folder_;
};

TEST_F(VolumeKinds, OneVolumeAsEachKindIsOnePicture) {
  const auto picture = [&](const VolumeScene& s) {
    const kernels::VolumeSplats splats = s.splats();
    EXPECT_EQ(splats.splats.size(), 49u);
    EXPECT_EQ(splats.empty, 11u);
    return volume_picture(s.view, splats, s.settings).pixels;
  };
  const auto regular = picture(scene("file = \"values.nrrd\"\n"));
  EXPECT_GT(regular[40 * 20 + 20].w, 0.5);
  for (const char* keys :
       {"file = \"values.nrrd\"\nx = [-2, -1, 0, 1, 2]\nz = [-1, 0, 1]\n",
        "file = \"values.nrrd\"\npositions = \"places.nrrd\"\n", "samples = \"samples.ply\"\n"}) {
    const auto other = picture(scene(keys));
    double worst = 0;
    for (std::size_t i = 0; i < regular.size(); ++i) {
      for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(other[i][c] - regular[i][c]));
    }
    EXPECT_LT(worst, 1e-6) << keys;  // weights are floats
  }
}

// Seen from the mirrored place, it is the mirrored picture.
TEST_F(VolumeKinds, EachKindCanBeMirrored) {
  for (const std::string keys :
       {"file = \"values.nrrd\"\n", "file = \"values.nrrd\"\nx = [-2, -1, 0.5, 1, 3]\n",
        "file = \"values.nrrd\"\npositions = \"places.nrrd\"\n", "samples = \"samples.ply\"\n"}) {
    const VolumeScene plain = scene(keys);
    const VolumeScene mirrored = scene("mirror = true\n" + keys, "[-4, 5, 12]");
    const auto of_plain = volume_picture(plain.view, plain.splats(), plain.settings).pixels;
    const auto of_mirrored = volume_picture(mirrored.view, mirrored.splats(), mirrored.settings).pixels;
    const double middle = plain.view.center().x;                      // where both look
    const int twice = static_cast<int>(std::lround(2 * middle - 1));  // a pixel's centre is half a step on
    double worst = 0, brightest = 0;
    for (int y = 0; y < 40; ++y) {
      for (int x = std::max(0, twice - 39); x <= std::min(39, twice); ++x) {
        const auto a = of_plain[static_cast<std::size_t>(40 * y + x)];
        const auto b = of_mirrored[static_cast<std::size_t>(40 * y + twice - x)];
        for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
        brightest = std::max(brightest, a.w);
      }
    }
    EXPECT_GT(brightest, 0.5) << keys;
    EXPECT_LT(worst, 1e-6) << keys;  // weights are floats
  }
}

// Moved by 2^22 with its camera, where floats are half a unit apart, it is the same picture.
TEST_F(VolumeKinds, WhereAVolumeLiesDoesNotMatter) {
  const auto picture = [&](const std::string& x, const std::string& eye, const std::string& target) {
    const VolumeScene placed = scene("file = \"values.nrrd\"\nx = " + x + "\n", eye, target);
    return volume_picture(placed.view, placed.splats(), placed.settings).pixels;
  };
  const auto near = picture("[-2, -1, 0.25, 1, 3]", "[4, 5, 12]", "[0, 0, 0]");
  EXPECT_GT(std::ranges::max(near, {}, [](const glm::dvec4& pixel) { return pixel.w; }).w, 0.5);
  EXPECT_EQ(near, picture("[4194302, 4194303, 4194304.25, 4194305, 4194307]", "[4194308, 5, 12]",
                          "[4194304, 0, 0]"));
}

TEST_F(VolumeKinds, VoxelsBeyondTheMachinesNumbersAreAUsersError) {
  const auto recorded = [&](const std::string& spacing) {
    folder_.file("large.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: " + spacing +
                                   "\nencoding: raw\n\n" + std::string(8, 'a'));
    const std::string text = "[volume]\nfile = \"large.nrrd\"\n[frame]\nwidth = 16\nheight = 16\n";
    return splatscope::error_of([&] { record(parse_volume_scene(text, folder_ / "large.toml")); });
  };
  EXPECT_EQ(recorded("1e6 1e6 1e6"), "no error");
  EXPECT_EQ(recorded("1e9 1e9 1e9"), (folder_ / "large.toml").string() +
                                         ": the machine's programs square voxels of this size beyond 32 "
                                         "bits, expected another unit of length");
}

TEST_F(VolumeKinds, NothingIsDrawnBeyondTheFarPlane) {
  VolumeScene all = scene("file = \"values.nrrd\"\n");
  all.view.far_plane = all.view.camera_space(glm::dvec3(0)).z;  // through the middle of three layers
  const kernels::VolumeSplats splats = all.splats();
  const auto beyond = static_cast<std::size_t>(std::ranges::count_if(splats.splats, [&](const auto& splat) {
    return all.view.camera_space(glm::dvec3(splat.position)).z > all.view.far_plane;
  }));
  EXPECT_GT(beyond, 10u);
  EXPECT_EQ(record(all).left_out, beyond);
}

// Twice as far apart along x, the voxels reach twice as far.
TEST_F(VolumeKinds, RectilinearKernelsFollowTheirSpacing) {
  const kernels::VolumeSplats splats = scene("file = \"values.nrrd\"\nx = [0, 1, 2, 4, 6]\n").splats();
  const auto& last = splats.kernels[splats.splats.back().kernel];
  EXPECT_DOUBLE_EQ(last[0][0], 4);
  EXPECT_DOUBLE_EQ(last[1][1], 1);
}

// Three layers, each of its own colour: with the file's own spacing a rectilinear grid is the regular one,
// and with any other it has as many sheets.
TEST_F(VolumeKinds, EachLayerOfAGridIsASheet) {
  write_file(folder_ / "thin.nrrd",
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 5 4 3\nspacings: 1 1 0.25\nencoding: raw\n\n" +
                 std::string(20, 'a') + std::string(20, 'b') + std::string(20, 'c'));
  const auto layers = [&](const std::string& keys, const std::string& eye = "[0, 0, -30]") {
    const std::string text = R"(transfer = [
  { value = 97, opacity = 1, color = [1, 0, 0] },
  { value = 98, opacity = 0.9, color = [0, 1, 0] },
  { value = 99, opacity = 1, color = [0, 0, 1] },
]
ambient = 1
diffuse = 0
specular = 0
[frame]
width = 40
height = 40
[camera]
target = [0, 0, 0]
near = 1
far = 100
)";
    return parse_volume_scene("[volume]\nfile = \"thin.nrrd\"\n" + keys + text + "eye = " + eye + "\n",
                              folder_ / "s.toml");
  };
  const auto picture = [](const VolumeScene& scene) {
    return volume_picture(scene.view, scene.splats(), scene.settings);
  };
  for (const char* eye : {"[0, 0, -30]", "[9, 8, 30]", "[3, -30, 8]", "[-30, 4, 1]"}) {
    const auto regular = picture(layers("", eye));
    const auto rectilinear = picture(layers("z = [-0.25, 0, 0.25]\n", eye));
    EXPECT_EQ(rectilinear.sheets, regular.sheets) << eye;
    double worst = 0;
    for (std::size_t i = 0; i < regular.pixels.size(); ++i) {
      for (int c = 0; c < 4; ++c)
        worst = std::max(worst, std::abs(rectilinear.pixels[i][c] - regular.pixels[i][c]));
    }
    EXPECT_LT(worst, 1e-6) << eye;
  }
  for (const char* keys : {"z = [-1, 0, 16]\n", "z = [0, 0.01, 0.02]\n", "positions = \"places.nrrd\"\n"}) {
    EXPECT_EQ(picture(layers(keys)).sheets, 3u) << keys;
    EXPECT_EQ(record(layers(keys)).sheets, 3u) << keys << ", on the machine";
  }
}

// What a scene leaves open of the camera frames where the voxels stand.
TEST_F(VolumeKinds, CamerasFrameTheirPlaces) {
  const auto framed = [&](const std::string& keys) {
    return parse_volume_scene("[volume]\n" + keys, folder_ / "s.toml").view.camera_space({0, 0, 0}).z;
  };
  const double near = framed("file = \"values.nrrd\"\npositions = \"places.nrrd\"\n");
  EXPECT_GT(framed("file = \"values.nrrd\"\nx = [-40, -20, 0, 20, 40]\n"), 5 * near);
  const double regular = framed("file = \"values.nrrd\"\n");
  EXPECT_NEAR(near, regular, 1e-9);
  EXPECT_NEAR(framed("samples = \"samples.ply\"\n"), regular, 1e-9) << "samples have an extent";
}

// A camera whose near plane is left open looks along an axis: the first layer of voxels lies behind that
// plane.
TEST_F(VolumeKinds, NoLayerLiesInTheNearPlane) {
  const auto framed = [&](const std::string& keys) {
    return parse_volume_scene("[volume]\n" + keys +
                                  "transfer = [{ value = 0, opacity = 0.5, color = [1, 1, 1] }]\n[camera]\n"
                                  "eye = [0, 0, -30]\ntarget = [0, 0, 0]\n[frame]\nwidth = 64\nheight = 64\n",
                              folder_ / "s.toml");
  };
  const std::string file = "file = \"values.nrrd\"\n";
  const double near_plane = framed(file).view.near_plane;
  for (const char* keys : {"", "z = [-1, 0, 1]\n", "positions = \"places.nrrd\"\n"}) {
    const VolumeScene scene = framed(file + keys);
    const kernels::VolumePicture picture = volume_picture(scene.view, scene.splats(), scene.settings);
    EXPECT_EQ(picture.left_out, 0u) << keys;
    EXPECT_EQ(picture.sheets, 3u) << keys;
    EXPECT_DOUBLE_EQ(scene.view.near_plane, near_plane) << keys << ", as of the same grid without places";
    EXPECT_EQ(record(scene).left_out, 0u) << keys << ", on the machine";
  }
}

TEST_F(VolumeKinds, SaysWhatIsWrong) {
  const std::string file = "file = \"values.nrrd\"\n";
  EXPECT_EQ(error(file + "x = [0, 1]\n"), "s.toml:3: volume.x has 2 places, expected 5, one for each voxel");
  for (const char* y : {"[0, 2, 1, 3]", "[0, 1, 1, 3]"})
    EXPECT_EQ(error(file + "y = " + y + "\n"),
              "s.toml:3: volume.y[2] is 1, expected a number from -1e+09 to 1e+09, above the one before it");
  EXPECT_EQ(error(file + "x = [0, 1, 2, 3, 4]\npositions = \"places.nrrd\"\n"),
            "s.toml:4: volume.positions beside volume.x, y or z, expected the one or the other");
  EXPECT_EQ(error("generator = \"constant\"\nvoxels = [5, 4, 2]\npositions = \"places.nrrd\"\n"),
            "places.nrrd: 5 x 4 x 3 places, expected 5 x 4 x 2, one for each voxel");
  EXPECT_EQ(error("generator = \"constant\"\nvoxels = [5, 1, 2]\nz = [0, 1]\n"),
            "s.toml:4: a grid with a single voxel along an axis, expected two where their places are given");
  for (const std::string& key : {file, std::string("generator = \"head\"\n")})
    EXPECT_EQ(error(key + "samples = \"samples.ply\"\n"),
              "s.toml:3: volume.samples beside a grid's keys (file, generator, voxels, x, y, z, positions), "
              "expected the one or the other");
  for (const char* key : {"generator = \"head\"\n", "voxels = [4, 4, 4]\n"})
    EXPECT_EQ(error(file + key),
              "s.toml:3: volume.generator or volume.voxels beside volume.file, expected one of them");
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const auto ply_error = [&](const std::string& text) {
    write_file(folder_ / "bad.ply", head + text);
    return error("samples = \"bad.ply\"\n");
  };
  EXPECT_EQ(ply_error("property float radius\nend_header\n0 0 0 1\n"),
            "bad.ply: property value of element vertex is missing, expected x, y, z, value and radius");
  EXPECT_EQ(ply_error("property float value\nend_header\n0 0 0 1\n"),
            "bad.ply: property radius of element vertex is missing, expected x, y, z, value and radius");
  const auto vertex_error = [&](const std::string& vertex) {
    return ply_error("property float value\nproperty float radius\nend_header\n" + vertex + "\n");
  };
  for (const char* wrong : {"0 0 nan 1 1", "0 0 0 inf 1", "0 0 0 1 nan"})
    EXPECT_EQ(vertex_error(wrong), "bad.ply: vertex 0 has a NaN or infinity, expected finite numbers");
  EXPECT_EQ(vertex_error("0 0 0 1 0"), "bad.ply: vertex 0 has radius 0, expected 1e-9 to 1e9");
  EXPECT_EQ(vertex_error("0 0 0 1 1e-9"), "no error");
  EXPECT_EQ(ply_error("property float value\nproperty float radius\nend_header\n3e38 3e38 0 1 1\n")
                .find("vertex 0 has a NaN"),
            std::string::npos)
      << "its sum is not, in single precision";
}

TEST(VolumeScene, IsNoSceneOfSurfels) {
  EXPECT_EQ(splatscope::error_of([] { parse_scene("\n[volume]\n", "a.toml"); }),
            "a.toml:2: [volume] in the place of surfels, expected a scene of surfels");
}

}  // namespace
}  // namespace splatscope::traces
