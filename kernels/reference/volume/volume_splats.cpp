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

}  // namespace

int VolumeSplats::sheet(const VolumeSplat& splat, int axis) const {
  const double place = (static_cast<double>(splat.position[axis]) - low[axis]) / sheet_spacing[axis];
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
        layer.push_back(
            classified(volume.position(voxel), value, look, gradient(volume, voxel), cell, flattening));
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
                           double sheet_spacing, const Flattening& flattening) {
  VolumeSplats result;
  result.sheet_spacing = glm::dvec3(sheet_spacing);
  result.low = glm::dvec3(std::numeric_limits<double>::infinity());
  for (const VolumeSample& sample : samples) {
    stop_if_asked();
    const double value = static_cast<double>(sample.value);
    const VoxelLook look = transfer(value);
    if (!(look.opacity > 0)) {
      ++result.empty;
      continue;
    }
    result.splats.push_back(
        classified(sample.position, value, look, sample.gradient, sample.cell, flattening));
    result.splats.back().kernel = static_cast<std::uint32_t>(result.kernels.size());
    result.kernels.push_back(sample.variance);
    result.low = glm::min(result.low, glm::dvec3(result.splats.back().position));
  }
  return result;
}

SheetOrder sheet_order(const VolumeSplats& splats, int axis) {
  std::vector<std::uint32_t> sheets(splats.splats.size());
  oneapi::tbb::parallel_for(std::size_t{0}, sheets.size(), [&](std::size_t k) {
    stop_if_asked();
    sheets[k] = static_cast<std::uint32_t>(splats.sheet(splats.splats[k], axis));
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
