#include "sim/units/vertex/vertex_unit.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"

namespace splatscope::sim {
namespace {

// Groups that go in at once, and the cycles in which they come out. `room`: groups that fit before the sink
// takes them.
std::vector<Cycle> shade(std::vector<std::uint32_t> sizes, const Machine::Vertex& spec, Scheduler scheduler,
                         Cycle taken_from = 0, int room = 8) {
  const isa::Program program =
      isa::assemble("vs_1_1\nmov r0, v0\nrcp r1.x, r0.x\nmul oPos, r0, r1.x\n", "test.vs");
  std::vector<VertexSchedule> schedules(1);
  schedules[0].slots = issue_slots(program, spec);
  schedules[0].groups = group_schedules(schedules[0].slots, spec);
  testing::TestDraw draw;
  draw.work.shaded_vertices = {0};  // some
  testing::Timed<VertexGroup> groups;
  for (std::uint32_t i = 0; i < sizes.size(); ++i) groups.emplace_back(0, VertexGroup{i, sizes[i]});
  groups.emplace_back(0, VertexGroup{});  // the end

  testing::Bench bench(scheduler);
  testing::Source<VertexGroup> source(groups);
  VertexUnit unit("vertex0", bench.completion(), spec, schedules);
  testing::Sink<VertexGroup> sink(taken_from);
  bench.add(source);
  bench.add(unit);
  bench.add(sink);
  Channel<VertexGroup> in("in", source, unit, 1), out("out", unit, sink, room);
  source.connect(in);
  unit.connect(in, out);
  sink.connect(out);
  bench.begin(draw.prepare(), {&unit});
  bench.run();
  std::vector<Cycle> cycles;
  for (const auto& [at, group] : sink.taken()) cycles.push_back(at);
  EXPECT_NE(bench.done_at(), kNever);
  return cycles;
}

Machine::Vertex one_thread() {
  Machine::Vertex spec;
  spec.vector_latency = 2;
  spec.scalar_latency = 3;
  return spec;
}

TEST(VertexUnit, GroupsFollowEachOtherAndComeOutWithTheirLastResult) {
  for (const Scheduler scheduler : {Scheduler::skip_ahead, Scheduler::referee}) {
    // Issues in 1, 3 and 6; the result in 8, seen in 9. The next starts in 7.
    EXPECT_EQ(shade({1, 1, 1}, one_thread(), scheduler), (std::vector<Cycle>{9, 15, 21}));
    Machine::Vertex spec = one_thread();
    spec.group_start_cycles = 2;
    EXPECT_EQ(shade({1, 1, 1}, spec, scheduler), (std::vector<Cycle>{9, 17, 25}));
  }
}

TEST(VertexUnit, ThreadsFillEachOthersWaits) {
  for (const Scheduler scheduler : {Scheduler::skip_ahead, Scheduler::referee}) {
    Machine::Vertex spec = one_thread();
    spec.threads = 3;
    // Nine issues in 1 to 9, the last result in 11; the smaller group behind it issues in 10 to 16.
    EXPECT_EQ(shade({3, 2}, spec, scheduler), (std::vector<Cycle>{12, 19}));
  }
}

TEST(VertexUnit, IsHeldUpWhenItsResultsAreNotTaken) {
  for (const Scheduler scheduler : {Scheduler::skip_ahead, Scheduler::referee}) {
    // One group fits outside and two in the pipeline. Taken from 100 on: room in 101, the next result seen in
    // 102.
    const auto cycles = shade({1, 1, 1, 1}, one_thread(), scheduler, 100, 1);
    ASSERT_EQ(cycles.size(), 4u);
    EXPECT_EQ(cycles[0], 100u);
    EXPECT_EQ(cycles[1], 102u);
    EXPECT_EQ(cycles[2], 104u);
    EXPECT_EQ(cycles[3], 101u + 7 + 1);  // started when the first left the pipeline
  }
}

}  // namespace
}  // namespace splatscope::sim
