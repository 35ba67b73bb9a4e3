#include "traces/neighbours.h"

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

#include "model/stop.h"
#include "traces/neighbour_search.h"

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

}  // namespace
}  // namespace splatscope::traces
