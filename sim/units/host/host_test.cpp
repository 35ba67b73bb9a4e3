#include "sim/units/host/host.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

// A command processor that reports each order ten cycles after it sees it.
class Echo final : public Unit {
 public:
  Echo() : Unit("echo") {}
  void connect(Channel<Order>& in, Channel<std::uint32_t>& out) {
    in_ = &in;
    out_ = &out;
  }
  Step advance(Cycle now) override {
    if (report_at_ == now) {
      out_->push(now, 0);
      report_at_ = kNever;
    }
    if (in_->can_pop(now)) {
      orders_.emplace_back(now, in_->pop(now).kind);
      report_at_ = now + 10;
    }
    return idle(std::min(report_at_, in_->next_visible()));
  }
  const testing::Timed<OrderKind>& orders() const { return orders_; }

 private:
  Channel<Order>* in_ = nullptr;
  Channel<std::uint32_t>* out_ = nullptr;
  Cycle report_at_ = kNever;
  testing::Timed<OrderKind> orders_;
};

constexpr Femtoseconds kPeriod = 10'000'000;  // ten nanoseconds

// A host between nothing and the echo, run to its end.
struct HostRun {
  HostRun(const Machine::Host& spec, const Trace& trace, const Host::Pixels& frame)
      : host("host", spec, kPeriod, trace, frame) {
    bus.add(host, 0);
    bus.add(echo, 1);
    host.connect(orders, reports);
    echo.connect(orders, reports);
    bus.run(kNever - 1);
  }
  ClockDomain bus{"bus", kPeriod, kPeriod, Scheduler::skip_ahead};
  Host host;
  Echo echo;
  Channel<Order> orders{"orders", host, echo, 1};
  Channel<std::uint32_t> reports{"reports", echo, host, 1};
};

TEST(Host, SendsOneCommandAfterTheOtherAndNormalisesPixelByPixel) {
  Trace trace;
  trace.width = 3;
  trace.height = 2;
  trace.commands = {Clear{}, Draw{}, NormalizeOnHost{}};
  Machine::Host spec;
  spec.command_nanoseconds = 100;
  spec.uncached_read_nanoseconds = 50;
  spec.uncached_read_bytes = 1;
  spec.division_nanoseconds = 30;
  spec.write_bytes_per_clock = 2;
  const HostRun run(spec, trace, {6, 4});
  const Host& host = run.host;

  ASSERT_TRUE(host.is_finished());
  // 10 cycles of preparation (none before the last), seen by the echo one later, its report one later.
  const testing::Timed<OrderKind> expected{{11, OrderKind::clear},
                                           {22 + 11, OrderKind::draw},
                                           {44 + 11, OrderKind::hand_over},
                                           {66 + 6 * 25 + 2, OrderKind::flush}};
  EXPECT_EQ(run.echo.orders(), expected);
  // A pixel: four reads of 5 cycles, 3 to divide, 2 to write; a cycle to turn to the last order.
  EXPECT_EQ(host.command_ends(), (std::vector<Cycle>{22, 44, 66 + 6 * 25 + 13}));
  EXPECT_EQ(host.finished_at(), host.command_ends().back());
}

TEST(Host, AWideReadServesSeveralPixels) {
  Machine::Host spec;
  spec.uncached_read_nanoseconds = 100;
  spec.division_nanoseconds = 0;
  spec.write_bytes_per_clock = 4;
  const auto nanoseconds = [&](int read_bytes) {
    spec.uncached_read_bytes = read_bytes;
    return Host::pixel_time(spec, 0, 4) / 1'000'000;
  };
  EXPECT_EQ(nanoseconds(1), 400u);
  EXPECT_EQ(nanoseconds(3), 200u);
  EXPECT_EQ(nanoseconds(4), 100u);
  EXPECT_EQ(nanoseconds(16), 25u);
}

TEST(Host, PresentWritesTheCachesBackAndTheLastOneEndsTheRun) {
  Trace trace;
  trace.commands = {Draw{}, Present{}, Draw{}, Present{}};
  Machine::Host spec;
  spec.command_nanoseconds = 100;
  const HostRun run(spec, trace, {6, 4});
  const testing::Timed<OrderKind> expected{{11, OrderKind::draw},
                                           {22 + 11, OrderKind::flush},
                                           {44 + 11, OrderKind::draw},
                                           {66 + 11, OrderKind::flush}};
  EXPECT_EQ(run.echo.orders(), expected);
  EXPECT_EQ(run.host.command_ends(), (std::vector<Cycle>{22, 44, 66, 88}));
  EXPECT_EQ(run.host.finished_at(), 88u);
}

TEST(Host, APixelIsWrittenInWholeClocks) {
  Machine::Host spec;
  spec.uncached_read_nanoseconds = 0;
  spec.division_nanoseconds = 0;
  for (const auto& [bytes, clocks] : {std::pair(2, 2u), {3, 2u}, {4, 1u}, {8, 1u}}) {
    spec.write_bytes_per_clock = bytes;
    EXPECT_EQ(Host::pixel_time(spec, kPeriod, 4), clocks * kPeriod) << bytes;
  }
}

}  // namespace
}  // namespace splatscope::sim
