#include "traces/hierarchy/ldc_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <ranges>

namespace splatscope::traces {
namespace {

constexpr int kAxisBits = 20;  // of a cell's number along one axis: three and the side fit 64 bits
constexpr std::uint32_t kCells = 1u << kAxisBits;
constexpr int kSideShift = 3 * kAxisBits;

// Where a surfel lies: its side (0 to 5) on top, below it the Morton code of its cell. A level up is three
// bits less.
using Code = std::uint64_t;

std::uint64_t spread_bits(std::uint32_t value) {  // two zeros between one bit and the next
  std::uint64_t v = value;
  v = (v | v << 32) & 0x001f00000000ffffu;
  v = (v | v << 16) & 0x001f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  v = (v | v << 2) & 0x1249249249249249u;
  return v;
}

// The LDI that shows a surfel best, and from which of its sides.
unsigned side_of(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return static_cast<unsigned>(2 * axis + (normal[axis] < 0));
}

// The layered depth pixels of the finest level.
struct Grid {
  kernels::Box box;
  double spacing = 0;
  std::uint32_t widest = 0;  // the largest number of a cell along any axis

  explicit Grid(std::span<const Surfel> surfels) {
    std::vector<float> radii;
    radii.reserve(surfels.size());
    for (const Surfel& s : surfels) {
      box.add(glm::dvec3(s.position));
      radii.push_back(s.radius);
    }
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::ranges::nth_element(radii, middle);
    const glm::dvec3 size = box.size();
    const double widest_size = std::max({size.x, size.y, size.z});
    // On a square grid the radius, the distance to the furthest of eight neighbours, is sqrt 2 spacings.
    spacing = std::max(double{*middle} / std::numbers::sqrt2, widest_size / (kCells - 1));
    widest = static_cast<std::uint32_t>(widest_size / spacing);
  }

  Code code(const Surfel& surfel) const {
    const glm::dvec3 cell = (glm::dvec3(surfel.position) - box.low) / spacing;
    Code code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto number = static_cast<std::uint32_t>(std::min(cell[axis], double{kCells - 1}));
      code |= spread_bits(number) << axis;
    }
    return code | Code{side_of(surfel.normal)} << kSideShift;
  }
};

// Surfels that become one. Colours and normals are averages over the surfels of the finest level, as the
// colours of Pfister's mipmaps are.
class Merger {
 public:
  void add(const Surfel& surfel, std::uint32_t stands_for) {
    const double n = stands_for;
    position_ += n * glm::dvec3(surfel.position);
    normal_ += n * glm::dvec3(surfel.normal);
    color_ += n * glm::dvec3(surfel.color);
    area_ += double{surfel.radius} * double{surfel.radius};
    count_ += stands_for;
  }
  std::uint32_t count() const { return count_; }

  // Covers the area of all, and at least reaches to the neighbours on the level's grid.
  Surfel merged(double spacing) const {
    const double n = count_;
    return {glm::vec3(position_ / n), glm::vec3(glm::normalize(normal_)),
            static_cast<float>(std::max(std::sqrt(area_), std::numbers::sqrt2 * spacing)),
            glm::vec3(color_ / n)};
  }

 private:
  glm::dvec3 position_{}, normal_{}, color_{};
  double area_ = 0;
  std::uint32_t count_ = 0;
};

// A level's surfels with their codes, on the way to the next coarser one.
struct Coded {
  std::vector<Code> codes;                // ascending
  std::vector<std::uint32_t> stands_for;  // surfels of the finest level
};

// Calls use(first, end) for each run of equal codes >> shift.
template <class Use>
void for_each_group(std::span<const Code> codes, int shift, const Use& use) {
  std::size_t first = 0;
  for (std::size_t i = 1; i <= codes.size(); ++i) {
    if (i < codes.size() && codes[i] >> shift == codes[first] >> shift) continue;
    use(first, i);
    first = i;
  }
}

void merge(const TreeLevel& fine, const Coded& from, TreeLevel& coarse, Coded& to) {
  coarse.spacing = 2 * fine.spacing;
  for_each_group(from.codes, 3, [&](std::size_t first, std::size_t end) {
    Merger merger;
    for (std::size_t i = first; i < end; ++i) merger.add(fine.surfels[i], from.stands_for[i]);
    coarse.surfels.push_back(merger.merged(coarse.spacing));
    to.codes.push_back(from.codes[first] >> 3);
    to.stands_for.push_back(merger.count());
  });
}

// The surfels of a block, and of each finer level those below it, of which they are averages.
using SurfelsByLevel = std::vector<std::span<const Surfel>>;

SurfelsByLevel surfels_of(std::span<const TreeLevel> finer, const TreeLevel& level, const Block& block) {
  SurfelsByLevel all{std::span(level.surfels).subspan(block.first, block.count)};
  std::size_t first = block.first_child, end = first + block.children;
  for (const TreeLevel& below : std::views::reverse(finer)) {
    const Block &front = below.blocks[first], &back = below.blocks[end - 1];
    all.push_back(std::span(below.surfels).subspan(front.first, back.first + back.count - front.first));
    first = front.first_child;
    end = std::size_t{back.first_child} + back.children;
  }
  return all;
}

template <class Use>
void for_each(const SurfelsByLevel& all, const Use& use) {
  for (const std::span<const Surfel> surfels : all) std::ranges::for_each(surfels, use);
}

void bound_box(const SurfelsByLevel& all, Block& block) {
  block.least_radius = block.greatest_radius = double{all.front().front().radius};
  for_each(all, [&](const Surfel& s) {
    block.box.add(glm::dvec3(s.position));
    block.least_radius = std::min(block.least_radius, double{s.radius});
    block.greatest_radius = std::max(block.greatest_radius, double{s.radius});
  });
}

void bound_cones(const SurfelsByLevel& all, Block& block) {
  glm::dvec3 sum{};
  for_each(all, [&](const Surfel& s) { sum += glm::dvec3(s.normal); });
  block.axis = glm::normalize(sum);  // never 0: one component has the same sign in all
  double least = 1;
  for_each(all,
           [&](const Surfel& s) { least = std::min(least, glm::dot(block.axis, glm::dvec3(s.normal))); });
  block.spread = std::acos(std::clamp(least, -1.0, 1.0));
  const glm::dvec3 middle = block.box.middle();
  double lowest = 0, highest = 0;  // where planes cut the axis
  for_each(all, [&](const Surfel& s) {
    const glm::dvec3 normal(s.normal), from_middle = glm::dvec3(s.position) - middle;
    const double along = glm::dot(block.axis, from_middle);
    block.bottom = std::min(block.bottom, along);
    block.top = std::max(block.top, along);
    block.width = std::max(block.width, glm::length(from_middle - along * block.axis));
    const double cut = glm::dot(normal, from_middle) / glm::dot(normal, block.axis);
    lowest = std::min(lowest, cut);
    highest = std::max(highest, cut);
  });
  if (!(least > 0)) return;  // the cones are empty
  block.behind = middle + lowest * block.axis;
  block.before = middle + highest * block.axis;
}

// The blocks of a level, `edge_bits` of a cell's number wide; without bounds.
void make_blocks(const Coded& coded, int edge_bits, TreeLevel& level) {
  for_each_group(coded.codes, 3 * edge_bits, [&](std::size_t first, std::size_t end) {
    Block block;
    block.first = static_cast<std::uint32_t>(first);
    block.count = static_cast<std::uint32_t>(end - first);
    block.below = std::accumulate(coded.stands_for.begin() + static_cast<std::ptrdiff_t>(first),
                                  coded.stands_for.begin() + static_cast<std::ptrdiff_t>(end), 0u);
    level.blocks.push_back(block);
  });
}

// Blocks of the coarse level take the fine level's blocks in turn, as many as hold the surfels they stand
// for.
void link_children(const TreeLevel& fine, const Coded& fine_coded, const Coded& coarse_coded, int edge_bits,
                   TreeLevel& coarse) {
  std::uint32_t child = 0;
  for (Block& block : coarse.blocks) {
    const Code code = coarse_coded.codes[block.first] >> 3 * edge_bits;
    block.first_child = child;
    while (child < fine.blocks.size() &&
           fine_coded.codes[fine.blocks[child].first] >> (3 * edge_bits + 3) == code) {
      ++child;
    }
    block.children = child - block.first_child;
  }
}

void bound_blocks(std::span<const TreeLevel> finer, TreeLevel& level) {
  for (Block& block : level.blocks) {
    const SurfelsByLevel all = surfels_of(finer, level, block);
    bound_box(all, block);
    bound_cones(all, block);
  }
}

}  // namespace

LdcTree build_ldc_tree(std::span<const Surfel> surfels, int block_surfels) {
  LdcTree tree;
  if (surfels.empty()) return tree;
  const Grid grid(surfels);
  const int edge_bits =
      std::clamp(static_cast<int>(std::lround(0.5 * std::log2(block_surfels))), 0, kAxisBits);

  std::vector<std::pair<Code, std::uint32_t>> sorted(surfels.size());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) sorted[i] = {grid.code(surfels[i]), i};
  std::ranges::sort(sorted);
  TreeLevel level;
  level.spacing = grid.spacing;
  Coded coded;
  for (const auto& [code, index] : sorted) {
    tree.order.push_back(index);
    level.surfels.push_back(surfels[index]);
    coded.codes.push_back(code);
  }
  coded.stands_for.assign(surfels.size(), 1);
  make_blocks(coded, edge_bits, level);
  bound_blocks({}, level);
  tree.levels.push_back(std::move(level));

  for (int bits = edge_bits; grid.widest >> bits != 0; ++bits) {  // until one cell holds everything
    TreeLevel coarse;
    Coded coarse_coded;
    merge(tree.levels.back(), coded, coarse, coarse_coded);
    make_blocks(coarse_coded, edge_bits, coarse);
    link_children(tree.levels.back(), coded, coarse_coded, edge_bits, coarse);
    bound_blocks(tree.levels, coarse);
    tree.levels.push_back(std::move(coarse));
    coded = std::move(coarse_coded);
  }
  return tree;
}

}  // namespace splatscope::traces
