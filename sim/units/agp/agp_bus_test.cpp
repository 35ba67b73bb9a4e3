#include "sim/units/agp/agp_bus.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

class Client final : public Unit {
 public:
  explicit Client(int reads) : Unit("client"), reads_(reads), port(*this, 16) {}
  Step advance(Cycle now) override {
    if (now != 0) return idle();
    for (int i = 0; i < reads_; ++i) port.read(now, static_cast<std::uint32_t>(64 * i), 64);
    return busy(1);
  }

 private:
  int reads_;

 public:
  MemoryPort port;
};

std::vector<Cycle> answers(int reads, const Machine::Agp& spec) {
  testing::Bench bench;
  Client client(reads);
  AgpBus agp("agp", spec, testing::kPeriod);
  bench.add(client);
  bench.add(agp);
  Channel<MemoryRequest> requests("requests", client, agp, 16);
  agp.connect(client.port, requests);
  client.port.connect({&requests}, 64);
  bench.run();
  std::vector<Cycle> cycles;
  for (int i = 0; i < reads; ++i) {
    cycles.push_back(client.port.oldest_ready());
    client.port.release_oldest();
  }
  return cycles;
}

TEST(AgpBus, LatenciesOverlapAndDataFollowsData) {
  // One clock is a nanosecond here. Requests are taken in 1, 2, 3; four clocks of data each; seen an edge
  // later.
  EXPECT_EQ(answers(3, {16, 20, 16}), (std::vector<Cycle>{1 + 20 + 4 + 1, 30, 34}));
}

TEST(AgpBus, SlowerLinesTakeLonger) {
  EXPECT_EQ(answers(2, {4, 20, 16}), (std::vector<Cycle>{38, 54}));
}

TEST(AgpBus, OnlySoManyRequestsAreOnTheBus) {
  // The second is taken when the first has gone, in 25.
  EXPECT_EQ(answers(2, {16, 20, 1}), (std::vector<Cycle>{26, 25 + 20 + 4 + 1}));
}

// Of one request in flight at a time the bus is never done. Of sixteen it takes three, in 1 to 3, waits for
// their data to come in 21, and moves them in three times four clocks.
TEST(AgpBus, ABusThatCouldTakeMoreIsNotBusy) {
  const auto books = [](int queue) {
    testing::Bench bench;
    Client client(3);
    AgpBus agp("agp", {16, 20, queue}, testing::kPeriod);
    bench.add(client);
    bench.add(agp);
    Channel<MemoryRequest> requests("requests", client, agp, 16);
    agp.connect(client.port, requests);
    client.port.connect({&requests}, 64);
    for (int i = 0; i < 4; ++i) bench.run();  // each request ends a run, so that the core can see its answer
    return bench.books(agp, 200).cycles;
  };
  EXPECT_EQ(books(16)[Step::kBusy], 3u + 3 * 4);
  EXPECT_EQ(books(16)[Step::kStarved], 21u - 4);
  EXPECT_EQ(books(1)[Step::kBusy], 3u * 24);
  EXPECT_EQ(books(1)[Step::kStarved], 0u);
}

TEST(AgpBus, ClientsTakeTurns) {
  Client first(2), second(2);
  AgpBus agp("agp", {16, 20, 16}, testing::kPeriod);
  EXPECT_EQ(testing::answers_of_two(first, second, agp, 2),
            (std::vector<std::pair<Cycle, Cycle>>{{26, 30}, {34, 38}}));
}

}  // namespace
}  // namespace splatscope::sim
