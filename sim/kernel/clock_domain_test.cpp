#include "sim/kernel/clock_domain.h"

#include <gtest/gtest.h>

#include <memory>

#include "model/error.h"
#include "sim/kernel/channel.h"
#include "sim/kernel/systemc_clocks.h"

namespace splatscope::sim {
namespace {

// Acts in the cycles of a list, and notes every cycle in which it was called.
class Sleeper final : public Unit {
 public:
  Sleeper(std::string name, std::vector<Cycle> acts) : Unit(std::move(name)), acts_(std::move(acts)) {}

  Step advance(Cycle now) override {
    called_.push_back(now);
    while (next_ < acts_.size() && acts_[next_] < now) ++next_;
    if (next_ == acts_.size()) return idle();
    if (acts_[next_] > now) return starved(acts_[next_]);
    ++next_;
    event(now, 1);
    return busy(now + 1);
  }
  const std::vector<Cycle>& called() const { return called_; }

 private:
  std::vector<Cycle> acts_;
  std::size_t next_ = 0;
  std::vector<Cycle> called_;
};

TEST(ClockDomain, VisitsOnlyTheCyclesInWhichAUnitCanAct) {
  ClockDomain domain("core", 1000, 1000, Scheduler::skip_ahead);
  Sleeper unit("unit", {3, 70, 1'000'000});  // on the wheel, beyond it, far away
  domain.add(unit, 0);
  domain.run(kNever - 1);
  EXPECT_EQ(unit.called(), (std::vector<Cycle>{0, 3, 4, 70, 71, 1'000'000, 1'000'001}));
  EXPECT_EQ(domain.next(), kNever);
}

TEST(ClockDomain, AFarWakeIsNotOvertakenByLaterNearOnes) {
  ClockDomain domain("core", 1000, 1000, Scheduler::skip_ahead);
  Sleeper far("far", {100});
  std::vector<Cycle> steps;
  for (Cycle at = 0; at < 200; at += 9) steps.push_back(at);
  Sleeper near("near", steps);
  domain.add(far, 0);
  domain.add(near, 1);
  domain.run(kNever - 1);
  EXPECT_EQ(far.called(), (std::vector<Cycle>{0, 100, 101}));
}

TEST(ClockDomain, TheRefereeCallsEveryUnitInEveryCycle) {
  ClockDomain domain("core", 1000, 1000, Scheduler::referee);
  domain.set_peers({});
  Sleeper first("first", {2, 5}), second("second", {3});
  domain.add(first, 0);
  domain.add(second, 1);
  domain.run(kNever - 1);
  EXPECT_EQ(first.called(), (std::vector<Cycle>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(second.called(), first.called());
}

TEST(ClockDomain, BooksAddUpAndAreTheSameForBothSchedulers) {
  for (const Scheduler scheduler : {Scheduler::skip_ahead, Scheduler::referee}) {
    ClockDomain domain("core", 1000, 1000, scheduler);
    Sleeper unit("unit", {3, 4, 90});
    domain.add(unit, 0);
    domain.run(kNever - 1);
    const Books books = domain.closed_books(0, 100);
    EXPECT_EQ(books.cycles[Step::kBusy], 3u);
    EXPECT_EQ(books.cycles[Step::kStarved], 3u + 85u);
    EXPECT_EQ(books.cycles[Step::kIdle], 9u);
    EXPECT_THROW(domain.closed_books(0, 50), ModelError);
  }
}

TEST(ClockDomain, SlowClocksBookReferenceCycles) {
  ClockDomain domain("bus", 4000, 1000, Scheduler::skip_ahead);
  Sleeper unit("unit", {10});
  domain.add(unit, 0);
  domain.run(kNever - 1);
  const Books books = domain.closed_books(0, 100);
  EXPECT_EQ(books.cycles[Step::kStarved], 40u);
  EXPECT_EQ(books.cycles[Step::kBusy], 4u);
  EXPECT_EQ(books.cycles[Step::kIdle], 56u);
}

// Sends a number down a channel and waits for it to come back, `rounds` times.
class Player final : public Unit {
 public:
  Player(std::string name, int rounds, bool serves)
      : Unit(std::move(name)), left_(rounds), has_ball_(serves) {}
  void connect(Channel<int>& in, Channel<int>& out) {
    in_ = &in;
    out_ = &out;
  }
  Step advance(Cycle now) override {
    if (!has_ball_ && in_->can_pop(now)) {
      in_->pop(now);
      event(now, 2);
      has_ball_ = true;
    }
    if (!has_ball_ || left_ == 0) return starved(in_->next_visible());
    out_->push(now, left_--);
    last_push_ = now;
    has_ball_ = false;
    return busy(now + 1);
  }
  Cycle last_push() const { return last_push_; }
  int left() const { return left_; }

 private:
  Channel<int>* in_ = nullptr;
  Channel<int>* out_ = nullptr;
  int left_;
  bool has_ball_;
  Cycle last_push_ = 0;
};

// Two players on two clocks, on the SystemC kernel.
struct Match {
  ClockDomain fast, slow;
  Player a{"a", 100, true}, b{"b", 100, false};
  std::unique_ptr<Channel<int>> down, up;

  explicit Match(Scheduler scheduler)
      : fast("fast", 3'636'364, 3'636'364, scheduler), slow("slow", 15'000'000, 3'636'364, scheduler) {
    fast.set_peers({&slow});
    slow.set_peers({&fast});
    fast.add(a, 0);
    slow.add(b, 1);
    down = std::make_unique<Channel<int>>("down", a, b, 1);
    up = std::make_unique<Channel<int>>("up", b, a, 1);
    a.connect(*up, *down);
    b.connect(*down, *up);
  }
  void run() {
    ClockDomain* const domains[] = {&fast, &slow};
    run_on_systemc(domains);
  }
};

TEST(SystemC, TwoClocksPlayTheSameMatchManyTimesInAProcess) {
  Match first(Scheduler::skip_ahead);
  first.run();
  EXPECT_EQ(first.a.left(), 0);
  EXPECT_EQ(first.b.left(), 0);
  // a pushes in cycle 0, b sees it at its cycle 1 and pushes at once, a sees that at the first edge after: a
  // round takes a slow cycle and what is left of the fast one it ends in.
  EXPECT_EQ(first.b.last_push(), 100u);
  for (int i = 0; i < 20; ++i) {
    Match again(i % 2 == 0 ? Scheduler::referee : Scheduler::skip_ahead);
    again.run();
    EXPECT_EQ(again.a.event_hash(), first.a.event_hash());
    EXPECT_EQ(again.b.event_hash(), first.b.event_hash());
    EXPECT_EQ(again.a.last_push(), first.a.last_push());
  }
}

class Thrower final : public Unit {
 public:
  Thrower() : Unit("thrower") {}
  Step advance(Cycle now) override {
    if (now == 5) throw ModelError("broken at 5");
    return busy(now + 1);
  }
};

TEST(SystemC, AnExceptionOfAUnitComesOutAndTheNextRunWorks) {
  ClockDomain domain("core", 1000, 1000, Scheduler::skip_ahead);
  Thrower unit;
  domain.add(unit, 0);
  ClockDomain* const domains[] = {&domain};
  EXPECT_THROW(run_on_systemc(domains), ModelError);
  Match match(Scheduler::skip_ahead);
  match.run();
  EXPECT_EQ(match.a.left(), 0);
}

}  // namespace
}  // namespace splatscope::sim
