#include "sim/units/command/command_processor.h"

#include <gtest/gtest.h>

#include "sim/testing/bench.h"
#include "sim/units/setup/triangle_setup.h"

namespace splatscope::sim {
namespace {

TEST(CommandProcessor, BeginsADrawAndReportsWhenItsUnitsAreDone) {
  testing::TestDraw draw;
  draw.add_triangle(3, 0, 1);
  draw.add_triangle(1, 0, 1);
  const std::vector<DrawJob> jobs{draw.prepare()};

  ClockDomain core("core", testing::kPeriod, testing::kPeriod, Scheduler::skip_ahead);
  Completion completion;
  testing::Source<Order> host({{0, Order{OrderKind::draw, 0}}});
  testing::Source<std::uint32_t> assembly({{20, 0u}, {30, 1u}});
  TriangleSetup setup("setup", completion, {2, 1, 8});
  testing::Sink<std::uint32_t> raster, reports;
  CommandProcessor command("command", completion);
  std::uint32_t number = 0;
  for (Unit* unit :
       {static_cast<Unit*>(&host), static_cast<Unit*>(&assembly), static_cast<Unit*>(&setup),
        static_cast<Unit*>(&raster), static_cast<Unit*>(&reports), static_cast<Unit*>(&command)}) {
    core.add(*unit, number++);
  }
  Channel<Order> orders("orders", host, command, 1);
  Channel<std::uint32_t> in("in", assembly, setup, 2), out("out", setup, raster, 8),
      done("done", command, reports, 1);
  MemoryPort port(command, 1);
  host.connect(orders);
  assembly.connect(in);
  setup.connect(in, out);
  raster.connect(out);
  reports.connect(done);
  command.connect(orders, done, port);
  command.set_draws(jobs, {&setup});
  core.run(kNever - 1);
  // The last triangle takes 31 and 32 of the setup; that is seen in 33, and the report in 34.
  EXPECT_EQ(reports.taken(), (testing::Timed<std::uint32_t>{{34, 0u}}));
  // Idle until the draw begins in 1, seen in 2; starved until the first triangle; idle again after the last.
  const Books books = core.closed_books(2, 40);
  EXPECT_EQ(books.cycles[Step::kStarved], (21u - 2u) + (31u - 23u));
  EXPECT_EQ(books.cycles[Step::kBusy], 4u);
}

TEST(CommandProcessor, AClearWritesTheSurfacesAndWaitsForMemory) {
  testing::Bench bench;
  testing::Source<Order> host({{0, Order{OrderKind::clear, 0}}});
  CommandProcessor command("command", bench.completion());
  testing::Sink<std::uint32_t> reports;
  bench.add(host);
  bench.add(command);
  bench.add(reports);
  Channel<Order> orders("orders", host, command, 1);
  Channel<std::uint32_t> done("done", command, reports, 1);
  testing::TestMemory memory(bench, command, 40, 2);
  host.connect(orders);
  reports.connect(done);
  command.connect(orders, done, memory.port);
  command.set_frame(nullptr, true, nullptr, {{0, 256}, {1024, 96}});
  bench.run();
  std::vector<std::uint32_t> bytes;
  for (const auto& [at, request] : memory.memory.requests()) bytes.push_back(request.bytes);
  EXPECT_EQ(bytes, (std::vector<std::uint32_t>{64, 64, 64, 64, 64, 32}));
  // Begun in 1, written from 2, two at a time as the stub takes one a cycle: taken from 3 to 8, the last
  // there in 48; reported then, seen in 49.
  EXPECT_EQ(reports.taken(), (testing::Timed<std::uint32_t>{{49, 0u}}));
}

// All four requests go out in 2, two to each channel; the second of these is there in 44.
TEST(CommandProcessor, AClearWritesToAllChannelsAtOnce) {
  testing::Bench bench;
  testing::Source<Order> host({{0, Order{OrderKind::clear, 0}}});
  CommandProcessor command("command", bench.completion());
  testing::Sink<std::uint32_t> reports;
  testing::FixedMemory even(40), odd(40);
  for (Unit* unit : {static_cast<Unit*>(&host), static_cast<Unit*>(&command), static_cast<Unit*>(&reports),
                     static_cast<Unit*>(&even), static_cast<Unit*>(&odd)})
    bench.add(*unit);
  Channel<Order> orders("orders", host, command, 1);
  Channel<std::uint32_t> done("done", command, reports, 1);
  Channel<MemoryRequest> to_even("even", command, even, 2), to_odd("odd", command, odd, 2);
  MemoryPort port(command, 1);
  even.connect(port, to_even);
  odd.connect(port, to_odd);
  port.connect({&to_even, &to_odd}, 64);
  host.connect(orders);
  reports.connect(done);
  command.connect(orders, done, port);
  command.set_frame(nullptr, true, nullptr, {{0, 256}});
  bench.run();
  EXPECT_EQ(reports.taken(), (testing::Timed<std::uint32_t>{{45, 0u}}));
}

}  // namespace
}  // namespace splatscope::sim
