#include "sim/kernel/channel.h"

#include <gtest/gtest.h>

namespace splatscope::sim {
namespace {

class Still final : public Unit {
 public:
  using Unit::Unit;
  Step advance(Cycle) override { return idle(); }
};

struct Pair {
  ClockDomain domain{"core", 1000, 1000, Scheduler::skip_ahead};
  Still producer{"producer"}, consumer{"consumer"};
  Pair() {
    domain.add(producer, 0);
    domain.add(consumer, 1);
  }
};

TEST(Channel, APushIsSeenAfterItsLatency) {
  Pair pair;
  Channel<int> one("one", pair.producer, pair.consumer, 4);
  one.push(10, 7);
  EXPECT_FALSE(one.can_pop(10));
  EXPECT_TRUE(one.can_pop(11));
  EXPECT_EQ(one.next_visible(), 11u);
  EXPECT_EQ(one.pop(11), 7);
  EXPECT_EQ(one.next_visible(), kNever);

  Channel<int> five("five", pair.producer, pair.consumer, 4, 5);
  five.push(10, 7);
  EXPECT_FALSE(five.can_pop(14));
  EXPECT_TRUE(five.can_pop(15));
}

TEST(Channel, APopFreesItsSlotInTheNextCycle) {
  Pair pair;
  Channel<int> channel("channel", pair.producer, pair.consumer, 3);  // not a power of two
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(channel.can_push(20));
    channel.push(20, i);
  }
  EXPECT_FALSE(channel.can_push(20));
  EXPECT_EQ(channel.next_free(), kNever);
  EXPECT_EQ(channel.pop(30), 0);
  EXPECT_FALSE(channel.can_push(30));  // blocked at t
  EXPECT_EQ(channel.next_free(), 31u);
  EXPECT_TRUE(channel.can_push(31));  // ready at t + 1
  channel.push(31, 3);
  EXPECT_FALSE(channel.can_push(31));
  EXPECT_EQ(channel.pop(40), 1);
  EXPECT_EQ(channel.pop(40), 2);
  channel.push(41, 4);
  channel.push(41, 5);
  EXPECT_FALSE(channel.can_push(41));
  for (int i = 3; i < 6; ++i) EXPECT_EQ(channel.pop(50), i);
  EXPECT_TRUE(channel.empty());
}

TEST(Channel, DescribesItsFill) {
  Pair pair;
  Channel<int> channel("triangles", pair.producer, pair.consumer, 3);
  channel.push(1, 1);
  EXPECT_EQ(channel.describe(), "triangles (producer to consumer): 1 of 3");
}

TEST(Channel, AcrossClocksAPushIsSeenAtTheFirstEdgeAfterIt) {
  ClockDomain fast("fast", 1000, 1000, Scheduler::skip_ahead);
  ClockDomain slow("slow", 3000, 1000, Scheduler::skip_ahead);
  Still producer("producer"), consumer("consumer");
  fast.add(producer, 0);
  slow.add(consumer, 1);
  Channel<int> channel("down", producer, consumer, 1);
  channel.push(6, 1);  // at 6000, an edge of both: seen at the next, 9000
  EXPECT_EQ(channel.next_visible(), 3u);
  channel.pop(3);  // at 9000: free at 10000
  EXPECT_EQ(channel.next_free(), 10u);
  channel.push(10, 2);  // at 10000: seen at 12000
  EXPECT_EQ(channel.next_visible(), 4u);
}

}  // namespace
}  // namespace splatscope::sim
