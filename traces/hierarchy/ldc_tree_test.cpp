#include "traces/hierarchy/ldc_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <random>

namespace splatscope::traces {
namespace {

std::vector<Surfel> random_surfels(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> any;
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Surfel> surfels(count);
  for (Surfel& s : surfels) {
    s.normal = glm::normalize(glm::vec3(any(random), any(random), any(random)));
    s.position = 10.0f * s.normal + 0.3f * glm::vec3(any(random), any(random), any(random));
    s.radius = 0.2f + 0.1f * unit(random);
    s.color = {unit(random), unit(random), unit(random)};
  }
  return surfels;
}

// The surfels of the finest level that a block stands for.
std::vector<Surfel> below(const LdcTree& tree, std::size_t level, const Block& block) {
  if (level == 0) {
    const auto first = tree.levels[0].surfels.begin() + block.first;
    return {first, first + block.count};
  }
  std::vector<Surfel> surfels;
  for (std::uint32_t child = 0; child < block.children; ++child) {
    const std::vector<Surfel> more =
        below(tree, level - 1, tree.levels[level - 1].blocks[block.first_child + child]);
    surfels.insert(surfels.end(), more.begin(), more.end());
  }
  return surfels;
}

TEST(LdcTree, HoldsEverySurfelOnceAtEveryLevel) {
  const std::vector<Surfel> surfels = random_surfels(5000, 1);
  const LdcTree tree = build_ldc_tree(surfels, 64);
  std::vector<std::uint32_t> order = tree.order;
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(i, order[i]);
  ASSERT_GE(tree.levels.size(), 4u);
  EXPECT_LE(tree.levels.back().blocks.size(), 6u) << "one cell, six sides";
  for (std::size_t l = 0; l < tree.levels.size(); ++l) {
    const TreeLevel& level = tree.levels[l];
    std::uint32_t next = 0, child = 0;
    std::size_t finest = 0;
    for (const Block& block : level.blocks) {
      EXPECT_EQ(next, block.first);
      next += block.count;
      if (l > 0) {
        EXPECT_EQ(child, block.first_child);
      }
      child += block.children;
      finest += below(tree, l, block).size();
    }
    EXPECT_EQ(level.surfels.size(), next);
    EXPECT_EQ(surfels.size(), finest);
    if (l > 0) {
      EXPECT_EQ(tree.levels[l - 1].blocks.size(), child);
      EXPECT_LT(level.surfels.size(), tree.levels[l - 1].surfels.size());
      EXPECT_DOUBLE_EQ(2 * tree.levels[l - 1].spacing, level.spacing);
    }
  }
  for (std::size_t k = 0; k < surfels.size(); ++k)
    ASSERT_EQ(surfels[tree.order[k]].position, tree.levels[0].surfels[k].position);
}

TEST(LdcTree, BlocksBoundWhatTheyStandFor) {
  const LdcTree tree = build_ldc_tree(random_surfels(5000, 2), 64);
  constexpr double kRounding = 1e-5;  // coarse surfels are rounded to float after averaging
  for (std::size_t l = 0; l < tree.levels.size(); ++l) {
    for (const Block& block : tree.levels[l].blocks) {
      std::vector<Surfel> surfels = below(tree, l, block);
      const auto own = tree.levels[l].surfels.begin() + block.first;
      surfels.insert(surfels.end(), own, own + block.count);
      for (const Surfel& s : surfels) {
        const glm::dvec3 p(s.position), n(s.normal);
        EXPECT_TRUE(glm::all(glm::lessThanEqual(block.box.low, p)) &&
                    glm::all(glm::greaterThanEqual(block.box.high, p)));
        EXPECT_LE(block.least_radius, s.radius);
        EXPECT_GE(block.greatest_radius, s.radius);
        EXPECT_GE(glm::dot(n, block.axis), std::cos(block.spread) - kRounding);
        const glm::dvec3 from_middle = p - block.box.middle();
        const double along = glm::dot(from_middle, block.axis);
        EXPECT_GE(along, block.bottom - kRounding);
        EXPECT_LE(along, block.top + kRounding);
        EXPECT_LE(glm::length(from_middle - along * block.axis), block.width + kRounding);
        if (block.spread >= 0.5 * std::numbers::pi) continue;
        EXPECT_GE(glm::dot(n, p - block.behind), -kRounding);
        EXPECT_LE(glm::dot(n, p - block.before), kRounding);
      }
    }
  }
}

// On a plane every pixel of a level has four of the next finer one.
TEST(LdcTree, LevelsOfAPlaneQuarter) {
  std::vector<Surfel> surfels;
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 64; ++y)
      surfels.push_back({glm::vec3(x, 0, y), glm::vec3(0, 1, 0), std::sqrt(2.0f), glm::vec3(x < 32, 0, 1)});
  const LdcTree tree = build_ldc_tree(surfels, 64);
  ASSERT_EQ(4u, tree.levels.size());
  EXPECT_EQ(64u, build_ldc_tree(surfels, 40).levels[0].blocks.size())
      << "64 is a smaller step from 40 than 16";
  for (std::size_t l = 0; l < tree.levels.size(); ++l) {
    const TreeLevel& level = tree.levels[l];
    const double scale = std::exp2(static_cast<double>(l));
    EXPECT_EQ(4096u >> 2 * l, level.surfels.size());
    EXPECT_EQ(64u >> 2 * l, level.blocks.size());
    glm::dvec3 color{};
    for (const Surfel& s : level.surfels) {
      EXPECT_FLOAT_EQ(static_cast<float>(scale * std::numbers::sqrt2), s.radius);
      EXPECT_EQ(glm::vec3(0, 1, 0), s.normal);
      color += glm::dvec3(s.color) / static_cast<double>(level.surfels.size());
    }
    EXPECT_NEAR(0.5, color.r, 1e-6);
    EXPECT_NEAR(1, color.b, 1e-6);
  }
}

// A pixel is radius / sqrt 2 wide, and twice that a level up, where a surfel reaches to its neighbours.
TEST(LdcTree, ALoneSurfelGrowsWithItsLevel) {
  const std::vector<Surfel> apart{{{0, 0, 0}, {0, 1, 0}, 1, {}}, {{100, 0, 0}, {0, 1, 0}, 1, {}}};
  const LdcTree tree = build_ldc_tree(apart, 1);
  ASSERT_EQ(tree.levels[1].surfels.size(), 2u);
  EXPECT_FLOAT_EQ(tree.levels[1].surfels[0].radius, 2);
}

TEST(LdcTree, OfNothingAndOfOneSurfel) {
  EXPECT_TRUE(build_ldc_tree({}, 256).levels.empty());
  const std::vector<Surfel> one = random_surfels(1, 3);
  const LdcTree tree = build_ldc_tree(one, 256);
  ASSERT_EQ(1u, tree.levels.size());
  EXPECT_EQ(1u, tree.levels[0].blocks.size());
}

// Further apart than 20 bits of cells reach.
TEST(LdcTree, SurfelsFarApart) {
  std::vector<Surfel> surfels = random_surfels(100, 4);
  surfels.back().position = {1e30f, -1e30f, 0};
  const LdcTree tree = build_ldc_tree(surfels, 64);
  EXPECT_EQ(100u, tree.levels[0].surfels.size());
  EXPECT_LE(tree.levels.size(), 20u);
}

}  // namespace
}  // namespace splatscope::traces
