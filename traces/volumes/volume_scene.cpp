#include "traces/volumes/volume_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "kernels/reference/volume/procedural.h"
#include "model/error.h"
#include "traces/framing.h"
#include "traces/scene_settings.h"
#include "traces/scene_text.h"
#include "traces/volumes/nrrd_file.h"

namespace splatscope::traces {
namespace {

constexpr glm::ivec3 kOwnVoxels[] = {
    {64, 64, 64}, {64, 64, 64}, {512, 512, 3}, {128, 128, 54}, {64, 64, 64}};  // by generator
constexpr double kMostVoxels = 1 << 26;
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
        file, settings.volume_line,
        fmt::format("volume.voxels is [{:g}, {:g}, {:g}], expected whole numbers, at most {:g} voxels{}",
                    keys.voxels.x, keys.voxels.y, keys.voxels.z, kMostVoxels,
                    cube ? ", as many along each axis and at least 2" : ""));
  }
  return voxels;
}

kernels::Volume volume_of(const SceneSettings& settings, const std::filesystem::path& file) {
  const VolumeKeys& keys = settings.volume;
  if (!keys.file.empty()) return read_nrrd(file.parent_path() / keys.file);
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

// The corners of the volume, as framing wants them.
std::vector<Surfel> corners_of(const kernels::Volume& volume) {
  std::vector<Surfel> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side{corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5};
    corners.push_back({.position = volume.center() + side * volume.extent()});
  }
  return corners;
}

kernels::View view_of(SceneSettings& settings, const kernels::Volume& volume, std::string_view file) {
  const Frame frame{settings.width, settings.height};
  frame_camera(corners_of(volume), frame, settings.camera_given, settings.camera);
  check_camera(settings, file);
  const Camera& camera = settings.camera;
  return kernels::look_at(camera.eye, camera.target, camera.up, camera.fov_y_degrees, frame.width,
                          frame.height, camera.near, camera.far);
}

}  // namespace

VolumeScene parse_volume_scene(std::string_view text, const std::filesystem::path& file) {
  SceneSettings settings = parse_settings(text, file.string());
  if (settings.volume_line == 0) {
    throw UserError(file.string(), 0, "has no [volume], expected a scene with a volume");
  }
  VolumeKeys& keys = settings.volume;
  if (!(glm::length(keys.rendering.light.toward_light) > 1e-9)) {
    throw UserError(file.string(), settings.volume_line, "volume.light is zero, expected a direction");
  }
  keys.rendering.light.toward_light = glm::normalize(keys.rendering.light.toward_light);
  kernels::Volume volume = volume_of(settings, file);
  kernels::TransferFunction transfer = transfer_of(keys, volume);
  const kernels::View view = view_of(settings, volume, file.string());
  return {file.stem().string(),
          std::move(volume),
          std::move(transfer),
          keys.kernel_variance,
          {.low = keys.surface_low, .high = keys.surface_high, .s = keys.surface_flatness},
          view,
          keys.rendering,
          keys.background};
}

VolumeScene load_volume_scene(const std::filesystem::path& name_or_path) {
  const SceneText scene = read_scene_text(name_or_path);
  return parse_volume_scene(scene.text, scene.file);
}

}  // namespace splatscope::traces
