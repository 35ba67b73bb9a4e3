#include "sim/units/vertex/vertex_unit.h"

#include <gtest/gtest.h>

#include <random>

#include "model/testing/random_seed.h"

namespace splatscope::sim {
namespace {

// One draw: which program, and after how many cycles each vertex is offered once it can be.
struct TestDraw {
  std::size_t program = 0;
  std::vector<Cycle> gaps;
};

// Stands for the command processor and the vertex fetch.
class Source final : public Unit {
 public:
  Source(DrawUnit& unit, Completion& completion, std::vector<TestDraw> draws)
      : Unit("source"), unit_(unit), completion_(completion), draws_(std::move(draws)) {
    for (std::size_t i = 0; i < draws_.size(); ++i) {
      DrawJob job;
      job.counts.shaded_vertices = draws_[i].gaps.size();
      job.vertex_program = draws_[i].program;
      jobs_.push_back(job);
    }
    completion_.set_waiter(*this);
  }
  void connect(Channel<VertexNumber>& out) { out_ = &out; }

  Step advance(Cycle now) override {
    if (draw_ == draws_.size()) return idle();
    const auto& gaps = draws_[draw_].gaps;
    if (!begun_) {
      completion_.start(now, 1);
      unit_.begin(jobs_[draw_]);
      unit_.wake(now + 1);
      begun_ = true;
      next_ = now + gaps.front();
    }
    if (sent_ <= gaps.size()) {
      if (next_ > now || !out_->can_push(now)) return busy(std::max(next_, out_->next_free()));
      const bool is_last = sent_ == gaps.size();
      out_->push(now, is_last ? kEndOfDraw : static_cast<VertexNumber>(sent_));
      ++sent_;
      next_ = now + (sent_ < gaps.size() ? gaps[sent_] : 1);
      return busy(now + 1);
    }
    if (completion_.done_at() > now) return busy(completion_.done_at());
    ++draw_;
    sent_ = 0;
    begun_ = false;
    return busy(now + 1);
  }

 private:
  DrawUnit& unit_;
  Completion& completion_;
  std::vector<TestDraw> draws_;
  std::vector<DrawJob> jobs_;
  Channel<VertexNumber>* out_ = nullptr;
  std::size_t draw_ = 0, sent_ = 0;
  bool begun_ = false;
  Cycle next_ = 0;
};

using Arrivals = std::vector<std::pair<Cycle, VertexNumber>>;

// Takes a vertex, then none for some cycles.
class Sink final : public Unit {
 public:
  explicit Sink(std::vector<Cycle> pauses) : Unit("sink"), pauses_(std::move(pauses)) {}
  void connect(Channel<VertexNumber>& in) { in_ = &in; }

  Step advance(Cycle now) override {
    if (next_ > now) return busy(next_);
    if (!in_->can_pop(now)) return starved(in_->next_visible());
    arrivals.emplace_back(now, in_->pop(now));
    next_ = now + 1 + pauses_[arrivals.size() % pauses_.size()];
    return busy(next_);
  }

  Arrivals arrivals;

 private:
  std::vector<Cycle> pauses_;
  Channel<VertexNumber>* in_ = nullptr;
  Cycle next_ = 0;
};

struct Case {
  Machine::Vertex spec;
  std::vector<std::vector<IssueSlot>> programs;
  std::vector<TestDraw> draws;
  std::vector<Cycle> pauses{0};
};

struct Outcome {
  Arrivals arrivals;
  std::uint64_t hash = 0;
  std::uint64_t taken = 0;
  std::vector<Cycle> books;  // busy, starved, idle, blocked by source (0), unit (1), sink (2)
};

Outcome run(const Case& test, Scheduler scheduler) {
  // Past the longest random case: 240 vertices of 81 slots that each wait 64 clocks, with gaps and pauses.
  constexpr Cycle kEnd = 2'000'000;
  ClockDomain domain("test", 1000, 1000, scheduler);
  Completion completion;
  VertexUnit unit("vertex", completion, test.spec, test.programs);
  Sink sink(test.pauses);
  Source source(unit, completion, test.draws);
  domain.add(unit, 0);
  domain.add(sink, 1);
  domain.add(source, 2);
  domain.set_peers({});
  Channel<VertexNumber> in("in", source, unit, VertexUnit::kInputVertices);
  Channel<VertexNumber> out("out", unit, sink, test.spec.output_vertices);
  source.connect(in);
  unit.connect(in, out);
  sink.connect(out);
  domain.run(kEnd);
  const Books books = domain.closed_books(0, kEnd);
  return {sink.arrivals,
          unit.event_hash(),
          unit.statistics(kNever)[0].value,
          {books.cycles.begin(), books.cycles.begin() + 6}};
}

std::vector<IssueSlot> independent_slots(std::size_t count) {
  IssueSlot slot;
  slot.has_vector = true;
  return std::vector<IssueSlot>(count, slot);
}

Case transform_case(int threads, int reload_cycles, std::size_t vertices) {
  Case test;
  test.spec.threads = threads;
  test.spec.vector_latency = 3;
  test.spec.reload_cycles = reload_cycles;
  test.spec.output_vertices = 4;
  test.programs = {independent_slots(4)};
  test.draws = {{0, std::vector<Cycle>(vertices, 0)}};
  return test;
}

Arrivals arrivals_of(const Case& test) {
  const Outcome outcome = run(test, Scheduler::skip_ahead);
  EXPECT_EQ(outcome.arrivals, run(test, Scheduler::referee).arrivals);
  return outcome.arrivals;
}

// The source pushes in 0; the unit takes in 1, issues in 2 to 5, has the last result in 8 and passes it on,
// seen in 9. The next vertex is taken in 5.
TEST(VertexUnit, OneThread) {
  EXPECT_EQ(arrivals_of(transform_case(1, 0, 3)), (Arrivals{{9, 0}, {13, 1}, {17, 2}}));
}

TEST(VertexUnit, ReloadingAThreadTakesTime) {
  EXPECT_EQ(arrivals_of(transform_case(1, 3, 3)), (Arrivals{{9, 0}, {16, 1}, {23, 2}}));
}

// Taken in 1, 2 and 3, issued in turn from 2 on: thread 0 in 2, 5, 8 and 11. It takes the next vertex in 14.
TEST(VertexUnit, ThreeThreads) {
  EXPECT_EQ(arrivals_of(transform_case(3, 3, 6)),
            (Arrivals{{15, 0}, {16, 1}, {17, 2}, {28, 3}, {29, 4}, {30, 5}}));
}

// Taken in 1, last slot in 5, reloaded for ten clocks after that, then told in 16 that the draw ends.
TEST(VertexUnit, IsBusyWhileItReloads) {
  const Case test = transform_case(1, 10, 1);
  for (const Scheduler scheduler : {Scheduler::skip_ahead, Scheduler::referee})
    EXPECT_EQ(run(test, scheduler).books[Step::kBusy], 16u);
}

TEST(VertexUnit, HoldsTwoVerticesAThread) {
  Case test = transform_case(3, 3, 20);
  test.pauses = {10'000'000};
  EXPECT_EQ(run(test, Scheduler::skip_ahead).taken, 1u + 4u + 6u);  // one to the sink, four in the channel
}

TEST(VertexUnit, IsBlockedByAFullChannel) {
  Case test = transform_case(1, 0, 20);
  test.pauses = {99};
  const Outcome outcome = run(test, Scheduler::skip_ahead);
  ASSERT_EQ(outcome.arrivals.size(), 20u);
  EXPECT_EQ(outcome.arrivals[19].first - outcome.arrivals[0].first, 1900u);
  EXPECT_GT(outcome.books[Step::kBlocked + 1], 1000u);
  EXPECT_EQ(outcome.books, run(test, Scheduler::referee).books);
}

std::vector<IssueSlot> random_slots(std::mt19937& random) {
  const auto up_to = [&](unsigned most) { return static_cast<unsigned>(random() % (most + 1)); };
  const auto mask = [&] { return ComponentMask{1} << up_to(48); };
  std::vector<IssueSlot> slots(1 + up_to(up_to(1) ? 80 : 5));
  for (IssueSlot& slot : slots) {
    for (unsigned i = up_to(2); i != 0; --i) slot.reads |= mask();
    slot.has_scalar = up_to(3) == 0;
    slot.has_vector = !slot.has_scalar || up_to(1) == 0;
    if (slot.has_vector && up_to(3) != 0) slot.vector_writes = mask();
    if (slot.has_scalar) slot.scalar_writes = mask();
  }
  return slots;
}

Case random_case(std::mt19937& random) {
  const auto between = [&](unsigned least, unsigned most) {
    return static_cast<int>(least + static_cast<unsigned>(random()) % (most - least + 1));
  };
  Case test;
  test.spec.threads = between(0, 9) == 0 ? 16 : between(1, 4);
  test.spec.vector_latency = between(1, 9);
  test.spec.scalar_latency = between(0, 3) == 0 ? 64 : between(1, 9);
  test.spec.scalar_interval = between(0, 7) == 0 ? 64 : between(1, 7);
  test.spec.reload_cycles = between(0, 7) == 0 ? 64 : between(0, 5);
  test.spec.output_vertices = between(1, 12);
  for (int i = 0; i < 2; ++i) test.programs.push_back(random_slots(random));
  for (int i = between(1, 4); i != 0; --i) {
    TestDraw draw;
    draw.program = static_cast<std::size_t>(between(0, 1));
    const bool starving = between(0, 1) == 1;
    for (int vertices = between(1, 60); vertices != 0; --vertices) {
      draw.gaps.push_back(static_cast<Cycle>(starving ? between(0, 300) : between(0, 1)));
    }
    test.draws.push_back(draw);
  }
  const bool blocking = between(0, 2) == 0;
  for (int i = 0; i < 20; ++i)
    test.pauses.push_back(static_cast<Cycle>(blocking ? between(0, 250) : between(0, 2)));
  return test;
}

TEST(VertexUnit, RefereeAndSkipAheadAgree) {
  std::mt19937 random(random_seed());
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Case test = random_case(random);
    const Outcome skipped = run(test, Scheduler::skip_ahead);
    const Outcome referee = run(test, Scheduler::referee);
    std::vector<VertexNumber> sent, arrived;
    for (const TestDraw& draw : test.draws) {
      for (std::size_t vertex = 0; vertex < draw.gaps.size(); ++vertex)
        sent.push_back(static_cast<VertexNumber>(vertex));
    }
    for (const auto& arrival : referee.arrivals) arrived.push_back(arrival.second);
    ASSERT_EQ(arrived, sent);
    ASSERT_EQ(skipped.arrivals, referee.arrivals);
    ASSERT_EQ(skipped.hash, referee.hash);
    ASSERT_EQ(skipped.books, referee.books);
  }
}

}  // namespace
}  // namespace splatscope::sim
