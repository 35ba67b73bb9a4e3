#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kernels/bounds.h"
#include "traces/scene.h"

// Surfels in layered depth cubes (LDCs) of an octree (Ren 2002, section 6.2, after Pfister et al. 2000).
namespace splatscope::traces {

// One layered depth image (LDI) of an octree cell, seen from one side: surfels whose normals have the same
// largest component with the same sign.
struct Block {
  std::uint32_t first = 0;  // its surfels in its level
  std::uint32_t count = 0;
  std::uint32_t first_child = 0;  // blocks of the next finer level; none at the finest
  std::uint32_t children = 0;
  std::uint32_t below = 0;  // surfels of the finest level that it stands for
  // Of its surfels and of all below it, those of the levels between too, so that what culls a block culls
  // whatever is drawn in its place. Object units.
  kernels::Box box;  // of the centres
  double least_radius = 0, greatest_radius = 0;
  // Normals lie within `spread` radians of `axis`. Along the axis the centres lie from `bottom` to `top`, as
  // seen from the middle of the box, and no further than `width` from it.
  glm::dvec3 axis{};
  double spread = 0;
  double bottom = 0, top = 0, width = 0;
  // Visibility cones, where the spread is less than a right angle: `behind` (`before`) is behind (before) the
  // plane of every surfel. Nobody at behind + v sees the face of one where -v is within pi/2 - spread of the
  // axis, and from before + v all faces are seen where v is.
  glm::dvec3 behind{}, before{};
};

struct TreeLevel {
  double spacing = 0;           // of the layered depth pixels, object units
  std::vector<Surfel> surfels;  // block by block
  std::vector<Block> blocks;    // in the order of their surfels
};

struct LdcTree {
  std::vector<TreeLevel> levels;     // the finest first; none without surfels
  std::vector<std::uint32_t> order;  // surfel k of the finest level is number order[k] of those given
};

// The finest level holds the surfels as they are. Its layered depth pixels are as far apart as the surfels
// would be on a square grid; those of each further level are twice as far apart, and the surfels that fall
// into one pixel and the depth of one are merged into one there. A block has `block_surfels` layered depth
// pixels, rounded to a square of a power of two. Surfels as in a Scene: finite, of radius > 0, with normals
// of unit length. The same tree for any number of threads.
LdcTree build_ldc_tree(std::span<const Surfel> surfels, int block_surfels);

}  // namespace splatscope::traces
