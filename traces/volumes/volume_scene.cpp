#include "traces/volumes/volume_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "kernels/bounds.h"
#include "kernels/reference/volume/procedural.h"
#include "model/error.h"
#include "model/stop.h"
#include "traces/framing.h"
#include "traces/scene_settings.h"
#include "traces/scene_text.h"
#include "traces/splat_trace.h"
#include "traces/volumes/nrrd_file.h"
#include "traces/volumes/sample_file.h"

namespace splatscope::traces {
namespace {

constexpr glm::ivec3 kOwnVoxels[] = {
    {64, 64, 64}, {64, 64, 64}, {512, 512, 3}, {128, 128, 54}, {64, 64, 64}};  // by generator
constexpr int kMostVoxels = 1 << 26;
constexpr int kShells = 4;
constexpr double kZebraPeriod = 0.11;

glm::ivec3 voxels_of(const SceneSettings& settings, std::string_view file) {
  const VolumeKeys& keys = settings.volume;
  glm::ivec3 voxels = kOwnVoxels[static_cast<int>(keys.generator)];
  if (keys.voxels == glm::dvec3(0)) return voxels;
  const bool cube =
      keys.generator == VolumeGenerator::marschner_lobb || keys.generator == VolumeGenerator::shells;
  bool good = keys.voxels.x * keys.voxels.y * keys.voxels.z <= kMostVoxels;
  for (int i = 0; i < 3; ++i) {
    const double count = keys.voxels[i];
    good = good && count >= (cube ? 2 : 1) && count == std::floor(count) && !(cube && count != keys.voxels.x);
    voxels[i] = static_cast<int>(count);
  }
  if (!good) {
    throw UserError(
        file, settings.line_of({"volume.voxels"}),
        fmt::format(
            "volume.voxels is [{:g}, {:g}, {:g}], expected {}, at most {} voxels in all, or three zeros",
            keys.voxels.x, keys.voxels.y, keys.voxels.z,
            cube ? "three times the same whole number from 2 on" : "whole numbers from 1 on", kMostVoxels));
  }
  return voxels;
}

bool is_generated(const VolumeKeys& keys) {
  return keys.generator != VolumeKeys{}.generator || keys.voxels != VolumeKeys{}.voxels;
}

kernels::Volume volume_of(const SceneSettings& settings, const std::filesystem::path& file) {
  const VolumeKeys& keys = settings.volume;
  if (!keys.file.empty()) {
    if (is_generated(keys))
      throw UserError(file.string(), settings.line_of({"volume.generator", "volume.voxels"}),
                      "volume.generator or volume.voxels beside volume.file, expected one of them");
    return read_nrrd(file.parent_path() / keys.file);
  }
  const glm::ivec3 n = voxels_of(settings, file.string());
  switch (keys.generator) {
    case VolumeGenerator::marschner_lobb:
      return kernels::marschner_lobb(n.x);
    case VolumeGenerator::shells:
      return kernels::concentric_shells(n.x, kShells);
    case VolumeGenerator::zebra:
      return kernels::zebra_texture(n.x, n.y, n.z, kZebraPeriod);
    case VolumeGenerator::head:
      return kernels::head_stand_in(n);
    case VolumeGenerator::constant:
      break;
  }
  return kernels::constant_volume(n, 2.0 / glm::dvec3(n));
}

// Nothing for the lowest quarter of the values, then grey that grows lighter and denser.
kernels::TransferFunction transfer_of(const VolumeKeys& keys, const kernels::Volume& volume) {
  if (!keys.transfer.empty()) return kernels::TransferFunction(keys.transfer);
  const auto [low, high] = std::ranges::minmax(volume.values);
  const double first = static_cast<double>(low), last = static_cast<double>(high);
  if (!(first < last)) return kernels::TransferFunction({{first, {0.3, glm::dvec3(1)}}});
  return kernels::TransferFunction(
      {{first + 0.25 * (last - first), {0, glm::dvec3(0.4)}}, {last, {0.3, glm::dvec3(1)}}});
}

// Places along an axis: those of the scene, or the grid's own.
std::vector<double> places_along(const SceneSettings& settings, const kernels::Volume& volume, int axis,
                                 std::string_view file) {
  const VolumeKeys& keys = settings.volume;
  std::vector<double> places = axis == 0 ? keys.x : axis == 1 ? keys.y : keys.z;
  const auto count = static_cast<std::size_t>(volume.size[axis]);
  if (!places.empty() && places.size() != count) {
    const std::string key = fmt::format("volume.{}", "xyz"[axis]);
    throw UserError(
        file, settings.line_of({key}),
        fmt::format("{} has {} places, expected {}, one for each voxel", key, places.size(), count));
  }
  if (places.empty()) {
    for (std::size_t i = 0; i < count; ++i)
      places.push_back(volume.origin[axis] + static_cast<double>(i) * volume.spacing[axis]);
  }
  return places;
}

// Of a rectilinear or curvilinear grid; empty where the grid is regular.
kernels::VoxelPlaces places_of(const SceneSettings& settings, const kernels::Volume& volume,
                               const std::filesystem::path& file) {
  const VolumeKeys& keys = settings.volume;
  const bool rectilinear = !keys.x.empty() || !keys.y.empty() || !keys.z.empty();
  if (!rectilinear && keys.positions.empty()) return {};
  const auto fail = [&](const std::string& what) {
    throw UserError(file.string(), settings.line_of({"volume.positions", "volume.x", "volume.y", "volume.z"}),
                    what);
  };
  if (rectilinear && !keys.positions.empty())
    fail("volume.positions beside volume.x, y or z, expected the one or the other");
  if (std::min({volume.size.x, volume.size.y, volume.size.z}) < 2)
    fail("a grid with a single voxel along an axis, expected two where their places are given");
  if (rectilinear) {
    std::array<std::vector<double>, 3> along;
    for (int axis = 0; axis < 3; ++axis)
      along[static_cast<std::size_t>(axis)] = places_along(settings, volume, axis, file.string());
    return [along](const glm::ivec3& voxel) {
      return glm::dvec3(along[0][static_cast<std::size_t>(voxel.x)],
                        along[1][static_cast<std::size_t>(voxel.y)],
                        along[2][static_cast<std::size_t>(voxel.z)]);
    };
  }
  const std::filesystem::path path = file.parent_path() / keys.positions;
  VoxelPositions positions = read_nrrd_positions(path);
  if (positions.size != volume.size) {
    throw UserError(
        path.string(), 0,
        fmt::format("{} x {} x {} places, expected {} x {} x {}, one for each voxel", positions.size.x,
                    positions.size.y, positions.size.z, volume.size.x, volume.size.y, volume.size.z));
  }
  return [positions = std::move(positions)](const glm::ivec3& voxel) { return positions.at(voxel); };
}

// Irregular data, and their values as a volume of one row.
void read_irregular(const SceneSettings& settings, const std::filesystem::path& file, VolumeScene& scene) {
  const VolumeKeys& keys = settings.volume;
  if (!keys.file.empty() || !keys.positions.empty() || !keys.x.empty() || !keys.y.empty() ||
      !keys.z.empty() || is_generated(keys)) {
    throw UserError(
        file.string(), settings.line_of({"volume.samples"}),
        "volume.samples beside a grid's keys (file, generator, voxels, x, y, z, positions), expected the "
        "one or the other");
  }
  scene.samples = read_samples(file.parent_path() / keys.samples, keys.kernel_variance);
  scene.volume.size = {static_cast<int>(scene.samples.size()), 1, 1};
  for (const kernels::VolumeSample& sample : scene.samples) scene.volume.values.push_back(sample.value);
}

// Those that the headers of a grid name.
void add_data_files(const SceneSettings& settings, const std::filesystem::path& folder,
                    std::vector<NamedFile>& files) {
  const VolumeKeys& keys = settings.volume;
  if (!keys.file.empty()) files.push_back({"the header", nrrd_data_file(folder / keys.file, 1)});
  if (!keys.positions.empty()) files.push_back({"the header", nrrd_data_file(folder / keys.positions, 3)});
}

// In x: columns change places, so that a grid's steps stay positive. The kernels of irregular data are
// spheres, which are their own mirror images.
void mirror(VolumeScene& scene) {
  kernels::Volume& volume = scene.volume;
  for (kernels::VolumeSample& sample : scene.samples) {
    sample.position.x = -sample.position.x;
    sample.gradient.x = -sample.gradient.x;
  }
  if (!scene.samples.empty()) return;
  const int last = volume.size.x - 1;
  for (auto row = volume.values.begin(); row != volume.values.end(); row += volume.size.x)
    std::reverse(row, row + volume.size.x);
  volume.origin.x = -(volume.origin.x + last * volume.spacing.x);
  if (!scene.places) return;
  scene.places = [places = std::move(scene.places), last](const glm::ivec3& voxel) {
    const glm::dvec3 place = places({last - voxel.x, voxel.y, voxel.z});
    return glm::dvec3(-place.x, place.y, place.z);
  };
}

// What a voxel's cell reaches about its place: half of its edges.
glm::dvec3 cell_reach(const VolumeScene& scene, const glm::ivec3& voxel) {
  const glm::dmat3 edges = kernels::cell_edges(scene.volume, voxel, scene.places);
  return 0.5 * (glm::abs(edges[0]) + glm::abs(edges[1]) + glm::abs(edges[2]));
}

// About the voxels' cells, not their places alone: the nearest layer must lie behind the near plane.
kernels::Box box_of(const VolumeScene& scene) {
  const kernels::Volume& volume = scene.volume;
  kernels::Box box;
  if (scene.samples.empty() && !scene.places)
    return {volume.center() - 0.5 * volume.extent(), volume.center() + 0.5 * volume.extent()};
  for (const kernels::VolumeSample& sample : scene.samples)
    box.add(sample.position, glm::dvec3(0.5 * std::cbrt(sample.cell)));
  if (!scene.places) return box;
  glm::ivec3 voxel;
  for (voxel.z = 0; voxel.z < volume.size.z; ++voxel.z) {
    for (voxel.y = 0; voxel.y < volume.size.y; ++voxel.y) {
      stop_if_asked();
      for (voxel.x = 0; voxel.x < volume.size.x; ++voxel.x)
        box.add(scene.places(voxel), cell_reach(scene, voxel));
    }
  }
  return box;
}

// Places in the world can be large and close to one another, more than floats can tell apart: they count from
// the middle of them all, and the camera with them. Returns the box that they are in then; a regular grid is
// centred as it is.
kernels::Box centered(const kernels::Box& box, VolumeScene& scene, SceneSettings& settings) {
  if (scene.samples.empty() && !scene.places) return box;
  const glm::dvec3 middle = box.middle();
  for (kernels::VolumeSample& sample : scene.samples) sample.position -= middle;
  if (scene.places) {
    scene.places = [places = std::move(scene.places), middle](const glm::ivec3& voxel) {
      return places(voxel) - middle;
    };
  }
  if (settings.camera_given.eye) settings.camera.eye -= middle;
  if (settings.camera_given.target) settings.camera.target -= middle;
  return {box.low - middle, box.high - middle};
}

// The corners of the volume, as framing wants them.
std::vector<Surfel> corners_of(const kernels::Box& box) {
  std::vector<Surfel> corners;
  for (std::size_t i = 0; i < 8; ++i) corners.push_back({.position = box.corner(i)});
  return corners;
}

kernels::View view_of(SceneSettings& settings, const kernels::Box& box, std::string_view file) {
  const FrameSize frame{settings.width, settings.height};
  const std::vector<Surfel> corners = corners_of(box);
  Camera& camera = settings.camera;
  frame_camera(corners, frame, settings.camera_given, camera);
  DepthRange depths;
  for (const Surfel& corner : corners)
    depths.add(glm::dot(glm::dvec3(corner.position) - camera.eye, ahead_of(camera)), 0);
  place_planes(depths, settings.camera_given, camera);
  check_camera(settings, file);
  return traces::view_of(camera, frame);
}

}  // namespace

VolumeScene parse_volume_scene(std::string_view text, const std::filesystem::path& file) {
  SceneSettings settings = parse_settings(text, file.string());
  if (!settings.gives("volume")) {
    throw UserError(file.string(), 0, "has no [volume], expected a scene with a volume");
  }
  VolumeKeys& keys = settings.volume;
  if (!(glm::length(keys.rendering.light.toward_light) > 1e-9)) {
    throw UserError(file.string(), settings.line_of({"volume.light"}),
                    "volume.light is zero, expected a direction");
  }
  keys.rendering.light.toward_light = glm::normalize(keys.rendering.light.toward_light);
  VolumeScene scene;
  scene.name = file.stem().string();
  scene.file = file.string();
  scene.files = files_named(settings, file.parent_path());
  scene.prefilter_line = settings.line_of({"volume.prefilter"});
  if (keys.samples.empty()) {
    scene.volume = volume_of(settings, file);
    scene.places = places_of(settings, scene.volume, file);
    add_data_files(settings, file.parent_path(), scene.files);
  } else {
    read_irregular(settings, file, scene);
  }
  if (keys.mirror) mirror(scene);
  scene.transfer = transfer_of(keys, scene.volume);
  scene.kernel_variance = keys.kernel_variance;
  scene.flattening = {
      .low = keys.surface_low, .high = keys.surface_high, .s = keys.surface_flatness, .normal = {}};
  scene.view = view_of(settings, centered(box_of(scene), scene, settings), file.string());
  scene.settings = keys.rendering;
  scene.background = keys.background;
  return scene;
}

kernels::VolumeSplats VolumeScene::splats() const {
  if (samples.empty() && !places) return grid_splats(volume, transfer, kernel_variance, flattening);
  kernels::PlacedSamples placed;
  if (places) {
    const auto seen = [&](float value) { return transfer(static_cast<double>(value)).opacity > 0; };
    placed = curvilinear_samples(volume, kernel_variance, places, seen);
  }
  const std::span<const kernels::VolumeSample> set = places ? placed.samples : samples;
  // Where they are not a grid's layers, sheets as thick as the samples are far apart, but not more than
  // anyone could want.
  constexpr double kMostSheets = 4096;
  double edges = 0;
  kernels::Box box;
  for (const kernels::VolumeSample& sample : set) {
    edges += std::cbrt(sample.cell);
    box.add(sample.position);
  }
  const glm::dvec3 extent = set.empty() ? glm::dvec3(1.0) : box.size();
  const double spacing = std::max({edges / static_cast<double>(std::max<std::size_t>(set.size(), 1)),
                                   std::max({extent.x, extent.y, extent.z}) / kMostSheets, 1e-30});
  kernels::VolumeSplats result = sample_splats(set, transfer, spacing, flattening, placed.layers);
  result.empty = volume.values.size() - result.splats.size();
  return result;
}

bool has_volume(const SceneText& scene) {
  return parse_settings(scene.text, scene.file.string()).gives("volume");
}

VolumeScene load_volume_scene(const std::filesystem::path& name_or_path) {
  const SceneText scene = read_scene_text(name_or_path);
  return parse_volume_scene(scene.text, scene.file);
}

}  // namespace splatscope::traces
