#include "traces/neighbour_search.h"

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

#include "model/stop.h"
#include "traces/neighbours.h"

namespace splatscope::traces {
namespace {

TEST(NeighbourSearch, StopsWhileItsTreeIsBuilt) {
  std::vector<Surfel> surfels(100);
  for (std::size_t i = 0; i < surfels.size(); ++i) surfels[i].position.x = static_cast<float>(i);
  stop_signal = SIGINT;
  EXPECT_THROW(NeighbourSearch{surfels}, Interrupted);
  stop_signal = 0;
  NeighbourSearch::Found found;
  NeighbourSearch(surfels).find(50, 3, found);
  EXPECT_EQ(found.distance(2), 1);
}

// Three places: many surfels share the first two, few the third.
TEST(NeighbourSearch, LooksAtNoMoreOfAPlaceThanItIsAskedFor) {
  constexpr std::size_t kMany = 100'000, kFew = 3;
  std::vector<Surfel> surfels(2 * kMany + kFew);
  for (std::size_t i = 0; i < surfels.size(); ++i)
    surfels[i].position.x = i < kMany ? 0.0f : i < 2 * kMany ? 1.0f : 3.0f;
  const NeighbourSearch search(surfels);
  NeighbourSearch::Found found;
  for (std::size_t i = 0; i < 2 * kMany; ++i) {
    search.find(i, 13, found);
    ASSERT_EQ(found.squared_distance, std::vector<double>(13, 0.0)) << i;
    for (const std::uint32_t near : found.index) ASSERT_EQ(near < kMany, i < kMany);
  }
  search.find(2 * kMany, 5, found);
  EXPECT_EQ(found.squared_distance, (std::vector<double>{0, 0, 0, 4, 4}));
}

// Those with others in the same place have none nearby: two of them look beyond their copy, five do not.
TEST(AverageSpacing, IsThatOfDifferentPlaces) {
  const auto spacing_of = [](std::initializer_list<float> places) {
    std::vector<Surfel> surfels;
    for (const float x : places) surfels.push_back({{x, 0, 0}, {0, 1, 0}, 1, {}});
    return average_spacing(surfels);
  };
  EXPECT_DOUBLE_EQ(spacing_of({0, 0, 1, 3}), (1 + 1 + 1 + 2) / 4.0);
  EXPECT_DOUBLE_EQ(spacing_of({0, 0, 0, 0, 0, 1, 3}), (1 + 2) / 2.0);
  EXPECT_EQ(spacing_of({0, 0}), 0);
}

}  // namespace
}  // namespace splatscope::traces
