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

TEST(AgpBus, ClientsTakeTurns) {
  testing::Bench bench;
  Client first(2), second(2);
  AgpBus agp("agp", {16, 20, 16}, testing::kPeriod);
  bench.add(first);
  bench.add(second);
  bench.add(agp);
  Channel<MemoryRequest> of_first("first", first, agp, 16), of_second("second", second, agp, 16);
  agp.connect(first.port, of_first);
  agp.connect(second.port, of_second);
  first.port.connect({&of_first}, 64);
  second.port.connect({&of_second}, 64);
  bench.run();
  for (const Cycle at : {26, 34}) {
    EXPECT_EQ(first.port.oldest_ready(), at);
    EXPECT_EQ(second.port.oldest_ready(), at + 4);
    first.port.release_oldest();
    second.port.release_oldest();
  }
}

}  // namespace
}  // namespace splatscope::sim
