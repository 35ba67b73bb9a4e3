#include "kernels/reference/volume/volume_splats.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "model/stop.h"

namespace splatscope::kernels {
namespace {

VolumeSplat classified(const glm::dvec3& position, double value, const VoxelLook& look,
                       const glm::dvec3& gradient, double cell, const Flattening& flattening) {
  VolumeSplat splat;
  splat.position = position;
  const double length = glm::length(gradient);
  if (length > 0) splat.normal = gradient / length;
  splat.color = look.color;
  splat.weight = static_cast<float>(look.opacity * std::cbrt(cell * cell));
  if (value >= flattening.low && value <= flattening.high) {
    if (flattening.normal) splat.normal = *flattening.normal;
    if (splat.normal != glm::vec3(0)) splat.flatness = static_cast<float>(1 - 1 / flattening.s);
  }
  return splat;
}

// The least cosine between the line of sight and the normals of layers that are sheets. Of three axes at
// right angles one has 0.577 at least; rays up to 30 degrees beside the line of sight meet the layers in
// order.
constexpr double kFacesTheEye = 0.5;

// Of the grid's own axes, where the layers along one face the eye.
std::optional<SheetAxis> layer_axis(const glm::dvec3& sight, const GridLayers& layers) {
  if (layers.voxels.empty()) return std::nullopt;
  std::optional<SheetAxis> result;
  double most = kFacesTheEye;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool last_is_nearest : {false, true}) {
      const double least =
          layers.facing[static_cast<std::size_t>(axis)].least_along(last_is_nearest ? -sight : sight);
      if (!(least > most)) continue;
      most = least;
      result = {kLayerAxes + axis, last_is_nearest};
    }
  }
  return result;
}

}  // namespace

SheetAxis sheet_axis(const View& view, const VolumeSplats& splats, std::optional<int> given) {
  // Camera z grows along each object axis by the third row of W.
  const glm::dvec3 slopes(view.object_to_camera[0][2], view.object_to_camera[1][2],
                          view.object_to_camera[2][2]);
  if (!given) {
    if (const auto layers = layer_axis(glm::normalize(slopes), splats.layers)) return *layers;
  }
  SheetAxis result;
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (given ? axis != *given : std::abs(slopes[axis]) <= most) continue;
    most = std::abs(slopes[axis]);
    result = {axis, slopes[axis] < 0};
  }
  return result;
}

int VolumeSplats::sheet(std::size_t splat, int axis) const {
  if (axis >= kLayerAxes) return layers.voxels[splat][axis - kLayerAxes];
  const double place = (static_cast<double>(splats[splat].position[axis]) - low[axis]) / sheet_spacing[axis];
  return static_cast<int>(std::max(0l, std::lround(place)));
}

VolumeSplats grid_splats(const Volume& volume, const TransferFunction& transfer, double kernel_variance,
                         const Flattening& flattening) {
  const double cell = volume.spacing.x * volume.spacing.y * volume.spacing.z;
  std::vector<std::vector<VolumeSplat>> layers(static_cast<std::size_t>(volume.size.z));
  oneapi::tbb::parallel_for(0, volume.size.z, [&](int z) {
    stop_if_asked();
    std::vector<VolumeSplat>& layer = layers[static_cast<std::size_t>(z)];
    glm::ivec3 voxel{0, 0, z};
    for (voxel.y = 0; voxel.y < volume.size.y; ++voxel.y) {
      for (voxel.x = 0; voxel.x < volume.size.x; ++voxel.x) {
        const double value = static_cast<double>(volume.value(voxel));
        const VoxelLook look = transfer(value);
        if (!(look.opacity > 0)) continue;
        const VolumeSplat splat =
            classified(volume.position(voxel), value, look, gradient(volume, voxel), cell, flattening);
        if (splat.weight > 0) layer.push_back(splat);
      }
    }
  });
  VolumeSplats result;
  result.kernels = {grid_variance(volume, kernel_variance)};
  result.low = volume.origin;
  result.sheet_spacing = volume.spacing;
  std::size_t count = 0;
  for (const auto& layer : layers) count += layer.size();
  result.splats.reserve(count);
  for (auto& layer : layers) {
    stop_if_asked();
    result.splats.insert(result.splats.end(), layer.begin(), layer.end());
    layer = {};
  }
  result.empty = volume.values.size() - count;
  return result;
}

VolumeSplats sample_splats(std::span<const VolumeSample> samples, const TransferFunction& transfer,
                           double sheet_spacing, const Flattening& flattening, const GridLayers& layers) {
  VolumeSplats result;
  result.sheet_spacing = glm::dvec3(sheet_spacing);
  result.low = glm::dvec3(std::numeric_limits<double>::infinity());
  result.layers.facing = layers.facing;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    stop_if_asked();
    const VolumeSample& sample = samples[i];
    const double value = static_cast<double>(sample.value);
    const VoxelLook look = transfer(value);
    const VolumeSplat splat =
        look.opacity > 0 ? classified(sample.position, value, look, sample.gradient, sample.cell, flattening)
                         : VolumeSplat{};
    if (!(splat.weight > 0)) {
      ++result.empty;
      continue;
    }
    result.splats.push_back(splat);
    result.splats.back().kernel = static_cast<std::uint32_t>(result.kernels.size());
    result.kernels.push_back(sample.variance);
    if (!layers.voxels.empty()) result.layers.voxels.push_back(layers.voxels[i]);
    result.low = glm::min(result.low, glm::dvec3(result.splats.back().position));
  }
  return result;
}

SheetOrder sheet_order(const VolumeSplats& splats, int axis) {
  std::vector<std::uint32_t> sheets(splats.splats.size());
  oneapi::tbb::parallel_for(std::size_t{0}, sheets.size(), [&](std::size_t k) {
    stop_if_asked();
    sheets[k] = static_cast<std::uint32_t>(splats.sheet(k, axis));
  });
  SheetOrder order;
  const std::size_t count = sheets.empty() ? 0 : std::size_t{*std::ranges::max_element(sheets)} + 1;
  order.first.assign(count + 1, 0);
  for (const std::uint32_t sheet : sheets) ++order.first[sheet + 1];
  for (std::size_t s = 1; s <= count; ++s) order.first[s] += order.first[s - 1];
  order.splats.resize(sheets.size());
  std::vector<std::uint32_t> next(order.first.begin(), order.first.end() - 1);
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    stop_if_asked();
    order.splats[next[sheets[k]]++] = static_cast<std::uint32_t>(k);
  }
  return order;
}

}  // namespace splatscope::kernels
