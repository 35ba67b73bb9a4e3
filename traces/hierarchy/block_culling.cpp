#include "traces/hierarchy/block_culling.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "model/primitive/primitive.h"
#include "traces/splat_reach.h"

namespace splatscope::traces {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Facing is decided on the rasteriser's grid, of 1/16 pixel on both machines. A quad whose sides are `size`
// pixels long when it faces the eye has twice a triangle's area size^2 cos. Rounding moves each corner by
// 1/32 at most in x and y, the area by that times the sum of the edges in the taxicab norm, 4 size, and by
// 6/32^2: only beyond this cosine the quad cannot turn round. 0.01 is for the rounding of the vertex
// programs. No less than kEdgeOnCosine, which is enough for quads of 0.95 pixels: from there on the same
// blocks whatever the size of the frame, so that frame rates by resolution compare pixels (Table 2).
double turning_cosine(double size) {
  constexpr double kStep = 1.0 / 32;
  return std::max(kEdgeOnCosine, 0.01 + (4 * kStep + 6 * kStep * kStep / size) / size);
}

// What lies on a clip plane may lie on either side: the machine computes depths in binary32. Of the lengths
// that it adds up, twice at most, eight operations and constants are off by 2^-23 each.
constexpr double kDepthRounding = 2e-6;

}  // namespace

// A box lies in a half-space if its eight corners do.
struct BlockCulling::Placed {
  std::array<glm::dvec3, 8> corners;                    // camera space
  double nearest = kUnbounded, furthest = -kUnbounded;  // camera z
  LeastCosines cosines;
  // Of the quads of both passes from their surfels' centres; and its part along camera z.
  double reach = kUnbounded, depth_reach = kUnbounded;
};

BlockCulling::BlockCulling(const kernels::View& view, const Splatting& settings)
    : views_{view}, settings_(settings) {
  if (settings.depth_offset_scheme == DepthOffsetScheme::camera_z) {  // as splat_trace moves the eye
    views_.push_back(view);
    views_.back().object_to_camera[3].z += settings.depth_offset;
  }
  const double w = 0.5 * view.width, h = 0.5 * view.height;
  sides_ = {glm::normalize(glm::dvec3(view.eta, 0, -w)), glm::normalize(glm::dvec3(-view.eta, 0, -w)),
            glm::normalize(glm::dvec3(0, view.eta, -h)), glm::normalize(glm::dvec3(0, -view.eta, -h))};
}

BlockCulling::Placed BlockCulling::place(const Block& block, const LeastCosines& known,
                                         const kernels::View& view) const {
  Placed placed;
  double distance = 0;  // largest
  for (std::size_t i = 0; i < placed.corners.size(); ++i) {
    const glm::dvec3 corner = view.camera_space(block.box.corner(i));
    placed.corners[i] = corner;
    placed.nearest = std::min(placed.nearest, corner.z);
    placed.furthest = std::max(placed.furthest, corner.z);
    distance = std::max(distance, glm::length(corner));
  }
  const glm::dvec3 axis = view.camera_direction(block.axis);
  // A cylinder about the axis holds the centres too.
  const double middle = view.camera_space(block.box.middle()).z;
  const double across = block.width * std::sqrt(std::max(0.0, 1 - axis.z * axis.z));
  const auto [least, most] = std::minmax({axis.z * block.bottom, axis.z * block.top});
  placed.nearest = std::max(placed.nearest, middle + least - across);
  placed.furthest = std::min(placed.furthest, middle + most + across);
  // n.(o - e) >= n.(apex - e), and n is within `spread` of the axis.
  const auto least_cosine = [&](const glm::dvec3& apex, double sign) {
    const glm::dvec3 ray = view.camera_space(apex);
    const double length = glm::length(ray);
    if (!(length > 0)) return -1.0;
    const double angle = std::acos(std::clamp(sign * glm::dot(axis, ray) / length, -1.0, 1.0)) + block.spread;
    return angle < 0.5 * std::numbers::pi ? std::cos(angle) * std::min(1.0, length / distance) : -1.0;
  };
  placed.cosines.away = std::max(known.away, least_cosine(block.behind, 1));
  placed.cosines.toward = std::max(known.toward, least_cosine(block.before, -1));

  // The programs hold z at the near plane behind it.
  const double cosine = std::max(placed.cosines.away, placed.cosines.toward);
  if (!(cosine > 0) || (placed.nearest < view.near_plane && placed.furthest > -view.near_plane))
    return placed;
  const double z = std::max(placed.furthest, view.near_plane);
  const double filter = filter_length(z, view.eta, cosine);
  if (filter > longest_filter(settings_, z)) return placed;
  placed.reach = quad_reach(settings_, block.greatest_radius, filter);
  const double from_z = std::acos(std::min(std::abs(axis.z), 1.0)) + block.spread;  // of normals
  const double terms = glm::length(glm::dvec3(view.object_to_camera[3])) + distance;
  placed.depth_reach =
      placed.reach * (from_z < 0.5 * std::numbers::pi ? std::sin(from_z) : 1) + kDepthRounding * terms;
  return placed;
}

// Culled where no pass can show it.
BlockFate BlockCulling::fate(const Block& block, LeastCosines& known) const {
  BlockFate all = fate(block, views_.front(), known);
  if (all != BlockFate::drawn && views_.size() > 1) {
    LeastCosines nothing;
    all = fate(block, views_.back(), nothing);
  }
  return all;
}

BlockFate BlockCulling::fate(const Block& block, const kernels::View& view, LeastCosines& known) const {
  const Placed placed = place(block, known, view);
  known = placed.cosines;
  if (is_outside(placed, view)) return BlockFate::outside_frustum;
  if (faces_away(block, placed, view)) return BlockFate::facing_away;
  return BlockFate::drawn;
}

bool BlockCulling::is_outside(const Placed& placed, const kernels::View& view) const {
  // The visibility pass moves its quads by z_t away from the eye.
  if (placed.furthest + placed.depth_reach + settings_.depth_offset < view.near_plane) return true;
  if (placed.nearest - placed.depth_reach > view.far_plane) return true;
  return std::ranges::any_of(sides_, [&](const glm::dvec3& side) {
    return std::ranges::all_of(
        placed.corners, [&](const glm::dvec3& corner) { return glm::dot(side, corner) > placed.reach; });
  });
}

bool BlockCulling::faces_away(const Block& block, const Placed& placed, const kernels::View& view) const {
  if (settings_.faces != Faces::front) return false;
  // Clipping cuts triangles into slivers, whose winding on the grid is anybody's guess.
  const double nearest = placed.nearest - placed.depth_reach;
  const double furthest = placed.furthest + placed.depth_reach + settings_.depth_offset;
  if (nearest < view.near_plane || furthest > view.far_plane) return false;
  const double guard = (primitive::kGuardBand - view.width - view.height) * nearest / view.eta;
  for (const glm::dvec3& corner : placed.corners)
    if (std::max(std::abs(corner.x), std::abs(corner.y)) + placed.reach > guard) return false;
  const double half_side = std::min(1.0, std::sqrt(2 * settings_.cutoff) * settings_.sigma);
  return placed.cosines.away > turning_cosine(2 * half_side * block.least_radius * view.eta / furthest);
}

}  // namespace splatscope::traces
