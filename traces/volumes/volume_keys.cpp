#include "traces/scene_keys.h"

namespace splatscope::traces {
namespace {

using S = SceneSettings;

constexpr double kMostValue = 1e30, kFarthest = 1e9;
constexpr kernels::VolumeSettings kDefaults;

kernels::PhongLight& light(S& s) {
  return s.volume.rendering.light;
}

}  // namespace

std::span<const SceneKey> volume_keys() {
  static const std::vector<SceneKey> kKeys = {
      {"volume", "file", "",
       "volume (NRRD, raw encoding), relative to the scene file; empty: `generator` makes it",
       TextValue{[](S& s) -> std::string& { return s.volume.file; }, ""}},
      {"volume", "generator", "", "what makes the volume where no file is given, in the cube from -1 to 1",
       ChoiceValue{[](S& s, int i) { s.volume.generator = VolumeGenerator(i); },
                   {"marschner-lobb", "shells", "zebra", "head", "constant"},
                   0}},
      {"volume", "voxels", "voxels",
       "of the generator along x, y and z, from 1 on (of \"marschner-lobb\" and \"shells\" three times the "
       "same, from 2 on) and at most 67108864 in all; three zeros: its own number",
       VectorValue{[](S& s) -> glm::dvec3& { return s.volume.voxels; }, {0, 0, 0}, 0, 2048}},
      {"volume", "x", "object units",
       "rectilinear grid: where its voxels stand along x, as many as there are; none: evenly spaced",
       PlacesValue{[](S& s) -> std::vector<double>& { return s.volume.x; }, -kFarthest, kFarthest}},
      {"volume", "y", "object units", "the same along y",
       PlacesValue{[](S& s) -> std::vector<double>& { return s.volume.y; }, -kFarthest, kFarthest}},
      {"volume", "z", "object units", "the same along z",
       PlacesValue{[](S& s) -> std::vector<double>& { return s.volume.z; }, -kFarthest, kFarthest}},
      {"volume", "positions", "",
       "curvilinear grid: where its voxels stand (NRRD, raw encoding, 4 dimensions, the first of them x y "
       "z), relative to the scene file",
       TextValue{[](S& s) -> std::string& { return s.volume.positions; }, ""}},
      {"volume", "samples", "", "irregular data in the place of a grid (PLY), relative to the scene file",
       TextValue{[](S& s) -> std::string& { return s.volume.samples; }, ""}},
      {"volume", "mirror", "", "mirrors the volume in x: for files whose coordinates are right-handed",
       BooleanValue{[](S& s) -> bool& { return s.volume.mirror; }, false}},
      {"volume", "transfer", "",
       "opacity and colour by value, straight lines between; the opacity of a path as long as the cube root "
       "of the voxel's cell, which is that of a layer of voxels where they are cubes; none: a grey ramp",
       TransferValue{[](S& s) -> std::vector<kernels::TransferPoint>& { return s.volume.transfer; }}},
      {"volume", "kernel_variance", "squared voxels", "of the reconstruction kernels along each axis",
       RealValue{[](S& s) -> double& { return s.volume.kernel_variance; }, 1, 0.01, 100}},
      {"volume", "surface_low", "",
       "voxels from this value on are flat kernels, across the gradient; none where it is above "
       "`surface_high`",
       RealValue{[](S& s) -> double& { return s.volume.surface_low; }, 1, -kMostValue, kMostValue}},
      {"volume", "surface_high", "", "up to this value",
       RealValue{[](S& s) -> double& { return s.volume.surface_high; }, 0, -kMostValue, kMostValue}},
      {"volume", "surface_flatness", "", "s of Zwicker 2002, Eq. 37: how many times thinner",
       RealValue{[](S& s) -> double& { return s.volume.surface_flatness; }, 1e4, 1, 1e6}},
      {"volume", "prefilter", "", "ewa: a Gaussian of one pixel; swan: scaled uniformly; none",
       ChoiceValue{[](S& s, int i) { s.volume.rendering.prefilter = kernels::VolumePrefilter(i); },
                   {"ewa", "swan", "none"},
                   0}},
      {"volume", "cutoff", "",
       "radial index at which a splat ends: 4 in the paper, where layers ripple by 8%",
       RealValue{[](S& s) -> double& { return s.volume.rendering.cutoff; }, kDefaults.cutoff, 0.5, 50}},
      {"volume", "ambient", "", "part of a voxel's colour that has no direction",
       RealValue{[](S& s) -> double& { return light(s).ambient; }, kDefaults.light.ambient, 0, 1}},
      {"volume", "diffuse", "", "part by the angle between gradient and light",
       RealValue{[](S& s) -> double& { return light(s).diffuse; }, kDefaults.light.diffuse, 0, 1}},
      {"volume", "specular", "", "white highlight",
       RealValue{[](S& s) -> double& { return light(s).specular; }, kDefaults.light.specular, 0, 1}},
      {"volume", "shininess", "", "exponent of the highlight",
       RealValue{[](S& s) -> double& { return light(s).shininess; }, kDefaults.light.shininess, 1, 1000}},
      {"volume", "light", "camera space", "direction toward the light: x right, y up, z into the picture",
       VectorValue{[](S& s) -> glm::dvec3& { return light(s).toward_light; }, {0, 0, -1}, -1, 1}},
      {"volume", "background", "r g b", "behind the volume",
       VectorValue{[](S& s) -> glm::dvec3& { return s.volume.background; }, {0, 0, 0}, 0, 1}},
  };
  return kKeys;
}

}  // namespace splatscope::traces
