#include "sim/units/memory/memory_channel.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/machine/parameters.h"
#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

using testing::Bench;

struct Access {
  std::uint32_t address;
  std::uint32_t bytes;
  bool write = false;
};

// Makes all its requests in cycle 0, and reports when the reads are answered.
class Client final : public Unit {
 public:
  explicit Client(std::vector<Access> accesses)
      : Unit("client"), accesses_(std::move(accesses)), port(*this, 64) {}

  Step advance(Cycle now) override {
    if (now != 0) return idle();
    for (const Access& access : accesses_) {
      if (access.write) {
        port.write(now, access.address, access.bytes);
      } else {
        port.read(now, access.address, access.bytes);
      }
    }
    return busy(1);
  }

 private:
  std::vector<Access> accesses_;

 public:
  MemoryPort port;
};

// Two banks of rows of 256 bytes: bank = (address / 256) % 2. A read of 16 bytes is two clocks of data.
Machine::Memory spec() {
  Machine::Memory memory;
  memory.channels = 1;
  memory.channel_bytes_per_clock = 8;
  memory.burst_bytes = 16;
  memory.interleave_bytes = 64;
  memory.banks = 2;
  memory.row_bytes = 256;
  memory.precharge_clocks = 3;
  memory.activate_clocks = 5;
  memory.cas_clocks = 4;
  memory.row_active_clocks = 10;
  memory.write_recovery_clocks = 6;
  memory.turnaround_clocks = 2;
  memory.bypass_limit = 4;
  memory.return_latency = 1;
  return memory;
}

struct Served {
  std::vector<Cycle> answers;  // of the reads, in their order, less the return latency: the end of their data
  Cycle written = 0;
  std::vector<Statistic> statistics;
};

Served serve(const std::vector<Access>& accesses, const Machine::Memory& memory) {
  Bench bench;
  Client client(accesses);
  MemoryChannel channel("memory", memory);
  bench.add(client);
  bench.add(channel);
  Channel<MemoryRequest> requests("requests", client, channel, 32);
  channel.connect(client.port, requests);
  client.port.connect({&requests}, 64);
  bench.run();
  Served served;
  for (const Access& access : accesses) {
    if (access.write) continue;
    served.answers.push_back(client.port.oldest_ready() - 1);
    client.port.release_oldest();
  }
  served.written = client.port.writes_done();
  served.statistics = channel.statistics(kNever);
  return served;
}

// A request made in 0 is taken in 1 and issued in 2.
TEST(MemoryChannel, TheFirstReadOfARowActivatesIt) {
  EXPECT_EQ(serve({{0, 16}}, spec()).answers, (std::vector<Cycle>{2 + 5 + 4 + 2}));
}

TEST(MemoryChannel, AnOpenRowFollowsAtOnce) {
  const Served served = serve({{0, 16}, {64, 16}, {128, 64}}, spec());
  EXPECT_EQ(served.answers, (std::vector<Cycle>{13, 15, 23}));
  EXPECT_EQ(served.statistics[2].value, 2u);  // row hits
  EXPECT_EQ(served.statistics[3].value, 1u);
  EXPECT_EQ(served.statistics[4].value, 2u + 2u + 8u);
}

TEST(MemoryChannel, AnotherBankOpensBesideTheFirst) {
  // Issued in 3: activate 5, CAS 4, so its data could come in 12; the bus is free in 13.
  EXPECT_EQ(serve({{0, 16}, {256, 16}}, spec()).answers, (std::vector<Cycle>{13, 15}));
}

TEST(MemoryChannel, AnotherRowOfTheBankWaitsForItsPrecharge) {
  // Activated in 2; precharge no sooner than 2 + 10; then 3 + 5 + 4, and two clocks of data.
  EXPECT_EQ(serve({{0, 16}, {512, 16}}, spec()).answers, (std::vector<Cycle>{13, 12 + 3 + 5 + 4 + 2}));
  Machine::Memory long_active = spec();
  long_active.row_active_clocks = 20;  // precharge in 22
  EXPECT_EQ(serve({{0, 16}, {512, 16}}, long_active).answers, (std::vector<Cycle>{13, 22 + 3 + 5 + 4 + 2}));
}

// A read bank precharges while its data are on their way, however long that takes.
TEST(MemoryChannel, ALongAccessHoldsNoBank) {
  Machine::Memory slow = spec();
  slow.cas_clocks += 20;
  EXPECT_EQ(serve({{0, 16}, {512, 16}}, slow).answers, (std::vector<Cycle>{13 + 20, 12 + 3 + 5 + 24 + 2}));
}

TEST(MemoryChannel, TheRequestWhoseDataComesFirstOvertakes) {
  // While the first still moves its 64 bytes (until 19) both others are there: the third hits the open row
  // and goes before the second, which waits for the precharge behind it: once the third is read out of the
  // bank, in 17, four clocks (CAS) before its data are.
  const Served served = serve({{0, 64}, {512, 16}, {64, 16}}, spec());
  EXPECT_EQ(served.answers, (std::vector<Cycle>{19, 17 + 3 + 5 + 4 + 2, 21}));
  Machine::Memory in_order = spec();
  in_order.bypass_limit = 0;
  const Served strict = serve({{0, 64}, {512, 16}, {64, 16}}, in_order);
  EXPECT_EQ(strict.answers[1], 15u + 3 + 5 + 4 + 2);
  EXPECT_GT(strict.answers[2], strict.answers[1]);
}

TEST(MemoryChannel, TheBusTurnsBetweenReadAndWrite) {
  const Served served = serve({{0, 16}, {64, 16, true}}, spec());
  EXPECT_EQ(served.answers, (std::vector<Cycle>{13}));
  EXPECT_EQ(served.written, 13u + 2 + 2);
}

// Written until 13; precharge 6 clocks later, then 3 + 5 + 4, and two clocks of data.
TEST(MemoryChannel, AWrittenRowRecoversBeforeItsPrecharge) {
  EXPECT_EQ(serve({{0, 16, true}, {512, 16}}, spec()).answers, (std::vector<Cycle>{13 + 6 + 3 + 5 + 4 + 2}));
}

TEST(MemoryChannel, ASmallReadCostsAWholeBurst) {
  const Served served = serve({{0, 8}, {64, 16}}, spec());
  EXPECT_EQ(served.answers, (std::vector<Cycle>{13, 15}));
  Machine::Memory fine = spec();
  fine.burst_bytes = 8;
  EXPECT_EQ(serve({{0, 8}, {64, 16}}, fine).answers, (std::vector<Cycle>{12, 14}));
}

// A clear asks for all that lies on a channel side by side.
TEST(MemoryChannel, ARequestMayBeOfAllThatTheInterleaveMayBe) {
  const auto parameter =
      std::ranges::find(machine::parameters(), "memory.interleave_bytes", &machine::Parameter::name);
  const auto most = static_cast<std::uint32_t>(std::get<machine::IntegerField>(parameter->field).most);
  Machine::Memory memory = spec();
  memory.interleave_bytes = memory.row_bytes = static_cast<int>(most);
  EXPECT_EQ(serve({{0, most}}, memory).answers, (std::vector<Cycle>{2 + 5 + 4 + most / 8}));
  memory.burst_bytes = 8;
  EXPECT_EQ(serve({{0, most, true}}, memory).written, 2 + 5 + 4 + most / 8);
}

TEST(MemoryPort, ConsecutiveAddressesGoRoundTheChannels) {
  Bench bench;
  Client client({{0, 64}, {64, 64}, {128, 64}, {192, 64}, {320, 64}});
  MemoryChannel a("a", spec()), b("b", spec());
  bench.add(client);
  bench.add(a);
  bench.add(b);
  Channel<MemoryRequest> to_a("to a", client, a, 8), to_b("to b", client, b, 8);
  a.connect(client.port, to_a);
  b.connect(client.port, to_b);
  client.port.connect({&to_a, &to_b}, 64);
  bench.run();
  EXPECT_EQ(a.statistics(kNever)[0].value, 2u);
  EXPECT_EQ(b.statistics(kNever)[0].value, 3u);
}

// Both wait for the same precharge: in 15, four clocks before the end of data; then for that of a row that is
// active from 18 for 10 clocks.
TEST(MemoryChannel, OfEqualsTheOldestGoesFirst) {
  EXPECT_EQ(serve({{0, 64}, {512, 16}, {1024, 16}}, spec()).answers,
            (std::vector<Cycle>{19, 15 + 3 + 5 + 4 + 2, 18 + 10 + 3 + 5 + 4 + 2}));
}

// Taken in turn and served in order, each two clocks behind the one before.
TEST(MemoryChannel, ClientsTakeTurns) {
  Client first({{0, 16}, {64, 16}, {128, 16}}), second({{16, 16}, {80, 16}, {144, 16}});
  Machine::Memory in_order = spec();
  in_order.bypass_limit = 0;
  MemoryChannel channel("memory", in_order);
  EXPECT_EQ(testing::answers_of_two(first, second, channel, 3),
            (std::vector<std::pair<Cycle, Cycle>>{{14, 16}, {18, 20}, {22, 24}}));
}

}  // namespace
}  // namespace splatscope::sim
