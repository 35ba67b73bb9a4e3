#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kernels/view.h"

// What the host decides of the sheets of a volume before it issues their draws: which voxels belong together,
// and how strongly they are drawn so that the steps of an 8-bit surface are used.
namespace splatscope::traces {

// What the host knows of a voxel in one view.
struct HostVoxel {
  bool drawn = false;
  bool flat = false;
  glm::vec3 color{};        // shaded
  float weight = 0;         // VolumeSplat's, of a flat kernel times flattened_weight
  float opacity = 0;        // at its centre
  glm::vec2 low{}, high{};  // its rectangle, pixels
  glm::vec3 conic{};        // xx, 2 xy, yy of the footprint
};

// Of pixels; right and bottom excluded.
struct Rectangle {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return right <= left || bottom <= top; }
};

// Voxels by their weights: faint ones beside opaque ones would have few of the 255 steps of a vertex's
// opacity, of the interpolated alpha and of the sheet. A level's weights are at most this part of those of
// the level before it.
inline constexpr std::size_t kVoxelLevels = 4;
inline constexpr double kVoxelLevelRatio = 1.0 / 4;

// The two ways to draw a voxel: its variance in the constants, or in the vertex.
enum VoxelKind : std::size_t { kSharedVariance, kOwnVariance, kVoxelKinds };

// A sheet is added up from the faintest level to the first. What it holds when the voxels of a level are
// added is `gain` times the opacities, as large as no sum comes to 1; before the next level it is multiplied
// by `rescale` of that level, over 255, and when it is composited by `composite` over 255.
struct SheetPlan {
  Rectangle rectangle;  // what its splats cover, and a pixel more
  std::array<std::array<std::vector<std::uint32_t>, kVoxelKinds>, kVoxelLevels> voxels;
  std::array<double, kVoxelLevels> opacity{};  // the largest at a splat's centre
  std::array<double, kVoxelLevels> gain{};
  std::array<int, kVoxelLevels> rescale{};  // 255: as it is
  int composite = 255;
};

struct SheetPlanner {
  const kernels::View& view;
  double cutoff;        // radial index at which a splat ends
  bool gains;           // false: each 1
  bool shared;          // voxels that are not flat have their variance in common
  double heaviest = 0;  // the largest weight of the frame

  std::size_t level_of(double weight) const;
  // The weight that a level's vertices are relative to.
  double weight_of(std::size_t level) const;
  // Of the voxels of these numbers.
  SheetPlan plan(std::span<const HostVoxel> voxels, std::span<const std::uint32_t> numbers) const;
};

}  // namespace splatscope::traces
