#include <benchmark/benchmark.h>

#include <deque>

#include "sim/testing/bench.h"

// The two hot mechanisms of the simulation kernel: channels, and the scheduler of a clock domain.
namespace splatscope::sim {
namespace {

class Still final : public Unit {
 public:
  using Unit::Unit;
  Step advance(Cycle) override { return idle(); }
};

// One item a cycle through a channel, without units that act.
void push_and_pop(benchmark::State& state) {
  ClockDomain domain("core", testing::kPeriod, testing::kPeriod, Scheduler::skip_ahead);
  Still producer("producer"), consumer("consumer");
  domain.add(producer, 0);
  domain.add(consumer, 1);
  Channel<std::uint64_t> channel("channel", producer, consumer, 8);
  Cycle now = 0;
  for (auto _ : state) {
    channel.push(now, now);
    benchmark::DoNotOptimize(channel.pop(++now));
  }
  state.counters["items"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(push_and_pop);

// Acts every `period` cycles, `times` times.
class Ticker final : public Unit {
 public:
  Ticker(Cycle period, Cycle times) : Unit("ticker"), period_(period), last_(period * times) {}
  Step advance(Cycle now) override {
    if (now >= last_) return idle();
    return idle(now + period_);
  }

 private:
  Cycle period_, last_;
};

// Cycles that the scheduler passes in a second: 16 units that all act every `period` cycles.
void schedule(benchmark::State& state) {
  constexpr Cycle kTimes = 10'000;
  constexpr std::uint32_t kUnits = 16;
  const auto period = static_cast<Cycle>(state.range(0));
  for (auto _ : state) {
    ClockDomain domain("core", testing::kPeriod, testing::kPeriod, Scheduler::skip_ahead);
    std::deque<Ticker> units;
    for (std::uint32_t i = 0; i < kUnits; ++i) domain.add(units.emplace_back(period, kTimes), i);
    domain.run(kNever - 1);
    benchmark::DoNotOptimize(domain.next());
  }
  const double rounds = static_cast<double>(state.iterations()) * static_cast<double>(kTimes);
  state.counters["calls"] = benchmark::Counter(rounds * kUnits, benchmark::Counter::kIsRate);
  state.counters["cycles"] =
      benchmark::Counter(rounds * static_cast<double>(period), benchmark::Counter::kIsRate);
}
BENCHMARK(schedule)->Arg(1)->Arg(20)->Arg(1000);  // the next cycle, on the wheel, beyond it

// An item a cycle from one unit to another: channel and scheduler together.
void pass_on(benchmark::State& state) {
  constexpr Cycle kItems = 10'000;
  testing::Timed<std::uint64_t> items;
  for (Cycle i = 0; i < kItems; ++i) items.emplace_back(0, i);
  for (auto _ : state) {
    testing::Bench bench;
    testing::Source<std::uint64_t> source(items);
    testing::Sink<std::uint64_t> sink;
    bench.add(source);
    bench.add(sink);
    Channel<std::uint64_t> channel("channel", source, sink, 8);
    source.connect(channel);
    sink.connect(channel);
    bench.run();
    benchmark::DoNotOptimize(sink.taken().data());
  }
  state.counters["items"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(kItems), benchmark::Counter::kIsRate);
}
BENCHMARK(pass_on);

}  // namespace
}  // namespace splatscope::sim
