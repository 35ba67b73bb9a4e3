#include "sim/work_window.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/error.h"
#include "sim/testing/cutter.h"
#include "sim/testing/random_trace.h"
#include "sim/testing/same_books.h"

namespace splatscope::sim {
namespace {

using testing::RandomMaker;
using testing::RandomTrace;

std::vector<std::uint32_t> numbers(std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> some(count);
  std::iota(some.begin(), some.end(), first);
  return some;
}

TEST(RecordRing, HoldsWhatIsNotForgottenByItsNumbers) {
  RecordRing<std::uint32_t> ring;
  std::uint32_t begin = 0, end = 0;
  for (const auto& [more, forgotten] :
       {std::pair{3u, 0u}, {0u, 0u}, {2u, 3u}, {6u, 2u}, {1u, 4u}, {5u, 0u}, {40u, 4u}}) {
    begin += forgotten;
    ring.forget(begin);
    ring.append(numbers(end, more));
    end += more;
    ASSERT_EQ(ring.end(), end);
    for (std::uint32_t i = begin; i < end; ++i) EXPECT_EQ(ring.records()[i], i);
  }
  ring.clear();
  EXPECT_EQ(ring.end(), 0u);
}

// Does the triangles to set up when it is told, of draws that do not blend.
class Idle final : public DrawUnit {
 public:
  using DrawUnit::DrawUnit;
  Step advance(Cycle) override { return idle(); }
  std::uint64_t items(const DrawJob& job) const override { return job.counts.triangles_set_up; }
  bool takes_part(const DrawJob& job) const override { return !job.draw->state.blend; }
  std::uint64_t cuts_passed(const DrawJob& job) const override { return cuts_passed_by_tags(job); }
  void do_one() { item_done(0); }
  // What was left out before a vertex.
  std::vector<std::uint32_t> pass(std::uint32_t vertex) {
    std::vector<std::uint32_t> passed;
    pass_cuts(&Cut::vertex, vertex,
              [&](const Cut& cut) { passed.insert(passed.end(), cut.vertices.begin(), cut.vertices.end()); });
    return passed;
  }
};

class WorkPartsTest : public ::testing::Test {
 protected:
  WorkPartsTest() : unit_("unit", completion_), parts_(source_, units_) {
    draw_.index_count = 12;
    job_.draw = &draw_;
    job_.command = 7;
    for (std::uint32_t i = 0; i < 3; ++i) part_.triangles.push_back({.quad_count = i, .quads_passed = i});
    part_.command = 7;
    part_.quads = {{.x = 1, .passed = 15}, {.x = 2, .passed = 15}, {.x = 3, .passed = 15}};
  }
  DrawWork last_part() const {
    DrawWork last;
    last.command = 7;
    last.triangles = {{.new_vertices = 1, .pieces = 2}};
    last.shaded_vertices = {9};
    return last;
  }

  Draw draw_;
  DrawJob job_;
  DrawWork part_;
  int asked_ = 0;
  const PartSource source_ = [this]() -> const DrawWork& { return ++asked_, part_; };
  Completion completion_;
  Idle unit_;
  const std::array<const DrawUnit*, 1> units_{&unit_};
  WorkParts parts_;
};

TEST_F(WorkPartsTest, AUnitAsksForMoreWhenItHasDoneAllOfWhatItKnows) {
  completion_.set_waiter(unit_);
  completion_.start(0, 1);
  ClockDomain domain("core", 1, 1, Scheduler::referee);
  domain.add(unit_, 0);
  parts_.begin(job_);
  EXPECT_EQ(asked_, 1);
  EXPECT_FALSE(job_.is_complete());
  EXPECT_EQ(job_.counts.colored_quads, 3u);
  EXPECT_TRUE(unit_.begin(job_));
  EXPECT_EQ(asked_, 1);
  EXPECT_EQ(job_.quads[2].x, 3);
  part_ = last_part();
  unit_.do_one();
  unit_.do_one();
  EXPECT_EQ(asked_, 1);
  unit_.do_one();
  EXPECT_EQ(asked_, 2);
  EXPECT_TRUE(job_.is_complete());
  EXPECT_EQ(job_.triangles[3].pieces, 2);
  EXPECT_EQ(job_.shaded_vertices[0], 9u);
  EXPECT_EQ(job_.triangles_clipped, 1u);
  EXPECT_EQ(completion_.done_at(), kNever);
  unit_.do_one();
  EXPECT_EQ(asked_, 2);
  EXPECT_EQ(completion_.done_at(), 1u);
}

TEST_F(WorkPartsTest, AUnitThatTakesNoPartInADrawAsksForNothing) {
  draw_.state.blend = true;
  part_.triangles.resize(1, {});
  part_.triangles[0].pieces = 0;
  part_.quads.clear();
  parts_.begin(job_);
  EXPECT_FALSE(unit_.begin(job_));
  EXPECT_EQ(asked_, 1);
  draw_.state.blend = false;
  EXPECT_FALSE(unit_.begin(job_));
  EXPECT_EQ(asked_, 4) << "there could be one in any of the four parts";
}

// Each is met once, and its memory taken for another one when it was.
TEST_F(WorkPartsTest, CutsAreKeptUntilTheyArePassed) {
  WorkWindow window(units_);
  window.begin(job_, 4, parts_);
  window.leave_out().vertices = {1, 2};
  window.leave_out().vertices = {3};
  window.add(last_part());
  unit_.begin(job_);
  window.leave_out().vertices = {4};
  EXPECT_EQ(job_.cuts->end(), 3u);
  EXPECT_EQ((*job_.cuts)[2].vertex, 1u);
  EXPECT_EQ(unit_.pass(0), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(unit_.pass(0), (std::vector<std::uint32_t>{}));
  window.add(last_part());
  EXPECT_TRUE(window.leave_out().vertices.empty());
  EXPECT_EQ(job_.cuts->end(), 4u);
  EXPECT_EQ(unit_.pass(1), (std::vector<std::uint32_t>{4}));

  DrawJob next = job_;
  next.counts = {};
  window.begin(next, 4, parts_);
  window.leave_out().vertices = {5};
  window.add(last_part());  // what the unit has passed of the draw before says nothing
  unit_.begin(next);
  EXPECT_EQ(unit_.pass(0), (std::vector<std::uint32_t>{5}));
}

// Met by a unit that cuts_passed() does not speak of.
TEST_F(WorkPartsTest, ACutThatIsForgottenTooEarlyIsAModelError) {
  WorkWindow window({});
  window.begin(job_, 4, parts_);
  window.leave_out().vertices = {1};
  window.add(last_part());
  window.add(last_part());
  unit_.begin(job_);
  EXPECT_THROW(unit_.pass(0), ModelError);
}

TEST_F(WorkPartsTest, NoCutIsKeptForAUnitThatTakesNoPart) {
  draw_.state.blend = true;
  WorkWindow window(units_);
  window.begin(job_, 4, parts_);
  window.leave_out().vertices = {1, 2};
  window.add(last_part());
  EXPECT_GE(window.leave_out().vertices.capacity(), 2u) << "in its memory";
}

TEST_F(WorkPartsTest, WhatDoesNotFitTheDrawIsAModelError) {
  const auto refused = [&](auto&& spoil) {
    const DrawWork right = part_;
    spoil(part_);
    EXPECT_THROW(parts_.begin(job_), ModelError);
    part_ = right;
    parts_.begin(job_);
    spoil(part_);
    EXPECT_THROW(parts_.take(), ModelError);
    part_ = right;
    job_.counts = {};
  };
  refused([](DrawWork& part) { part.command = 8; });
  refused([](DrawWork& part) { part.samples_only = true; });
  refused([](DrawWork& part) { part.quads.pop_back(); });
  refused([](DrawWork& part) { part.quads[1].passed = 0; });
  refused([](DrawWork& part) { part.shaded_vertices.push_back(1); });
  refused([](DrawWork& part) { part.texel_blocks.push_back(1); });
  refused([](DrawWork& part) { part.triangles.resize(5); });
  refused([](DrawWork& part) {
    part = {};
    part.command = 7;
  });
}

class PartsOfRandomTraces : public ::testing::TestWithParam<unsigned> {};

// Work that comes while the simulation runs, in parts of any size.
TEST_P(PartsOfRandomTraces, GiveWhatAllOfItGives) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  RandomMaker maker(GetParam());
  const RandomTrace made = maker.trace();
  const Machine machine = maker.machine();
  const Result at_once = simulate(made.trace, made.work, machine);
  for (const std::size_t most : {1, 7, 1000}) {
    testing::Cutter cutter(made.work, most, GetParam());
    const Result beside = simulate_beside(
        made.trace, [&]() -> const DrawWork& { return cutter.next(); }, machine);
    EXPECT_TRUE(cutter.is_at_the_end());
    EXPECT_EQ(beside.event_hash, at_once.event_hash);
    testing::expect_same_times(beside, at_once);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PartsOfRandomTraces, ::testing::Range(1u, 51u));

}  // namespace
}  // namespace splatscope::sim
