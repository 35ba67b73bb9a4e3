#include "studies/work_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>

#include "model/testing/draws.h"
#include "model/testing/sanitized.h"
#include "sim/fidelity/sampled.h"
#include "studies/heat_maps.h"
#include "studies/peak_memory.h"
#include "studies/run.h"

namespace splatscope::studies {
namespace {

void put(WorkQueue& queue, std::uint32_t command) {
  DrawWork work;
  work.command = command;
  queue.put(work);
}

TEST(WorkQueue, DrawsComeInOrderThoughFewCanWait) {
  constexpr std::uint32_t kAhead = 4, kDraws = 10 * kAhead;
  WorkQueue queue(kAhead);
  std::atomic<std::uint32_t> made = 0;
  std::thread maker([&] {
    for (; made < kDraws; ++made) put(queue, made);
  });
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    EXPECT_EQ(queue.next().command, i);
    EXPECT_LE(made, i + 1 + kAhead);
  }
  maker.join();
}

TEST(WorkQueue, AFailureComesAfterWhatWasMadeBefore) {
  WorkQueue queue(2);
  put(queue, 7);
  queue.fail(std::make_exception_ptr(std::runtime_error("no more")));
  EXPECT_EQ(queue.next().command, 7u);
  EXPECT_THROW(queue.next(), std::runtime_error);
}

TEST(WorkQueue, AStopEndsTheOneThatWaitsToPut) {
  WorkQueue queue(2);
  std::thread maker([&] {
    EXPECT_THROW(
        {
          for (std::uint32_t i = 0;; ++i) put(queue, i);
        },
        Interrupted);
  });
  queue.next();
  queue.stop();
  maker.join();  // or the test hangs
}

Trace plane_of_several_draws(const Machine& machine) {
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 150\nrows = 150\n[frame]\nwidth = 128\nheight = 128\n"
      "[capture]\nviews = 1\nframe_size = 64\n",
      "plane");
  return traces::record(scene, machine.numbers).trace;
}

// An estimate needs no more of the work than the samples that are recorded for it.
TEST(RunFrame, ThroughputOfSamplesIsThatOfAllWork) {
  const Machine machine = machine::load(machine::kGeForce4);
  const Trace trace = plane_of_several_draws(machine);
  const Rendered rendered = render(trace, render_options(machine));
  const sim::Result estimate = time_frame(trace, rendered.work, machine, Fidelity::throughput);
  const FrameRun run = run_frame(trace, machine, Fidelity::throughput);
  EXPECT_EQ(run.timing->cycles, estimate.cycles);
  ASSERT_EQ(run.timing->units.size(), estimate.units.size());
  for (std::size_t unit = 0; unit < estimate.units.size(); ++unit)
    EXPECT_EQ(run.timing->units[unit].busy, estimate.units[unit].busy) << estimate.units[unit].name;
  EXPECT_EQ(run.rendered.counters.fragments_passed, rendered.counters.fragments_passed);
}

// The function beside the time: the same picture, work and cycles as one after the other.
TEST(RunFrame, FunctionBesideTimeIsFunctionThenTime) {
  const Machine machine = machine::load(machine::kRadeon8500);
  const Trace trace = plane_of_several_draws(machine);
  const Rendered rendered = render(trace, render_options(machine));
  ASSERT_GT(rendered.work.size(), 2u);  // several draws, or nothing runs beside anything
  const sim::Result timing = sim::simulate(trace, rendered.work, machine);
  const FrameRun run = run_frame(trace, machine, Fidelity::cycle);
  EXPECT_EQ(run.timing->event_hash, timing.event_hash);
  EXPECT_EQ(run.timing->cycles, timing.cycles);
  EXPECT_EQ(run.rendered.counters.fragments_passed, rendered.counters.fragments_passed);
  EXPECT_TRUE(run.rendered.work.empty());
  for (std::size_t pixel = 0; pixel < 128 * 128; ++pixel)
    ASSERT_EQ(run.rendered.frame.color(pixel), rendered.frame.color(pixel)) << "pixel " << pixel;
  const sim::Result estimate = time_frame(trace, rendered.work, machine, Fidelity::sampled, {.seed = 5});
  EXPECT_GT(estimate.cycles_plus_minus, 0);
  const FrameRun sampled = run_frame(trace, machine, Fidelity::sampled, {}, {}, {.seed = 5});
  EXPECT_EQ(sampled.timing->cycles, estimate.cycles);
  EXPECT_EQ(sampled.timing->cycles_plus_minus, estimate.cycles_plus_minus);
  EXPECT_TRUE(sampled.rendered.work.empty());
}

// Where a few samples say too little, more are taken: of the time, not of the picture.
TEST(RunFrame, ASecondRunOfSamplesDrawsNothingAgain) {
  Machine machine = machine::load(machine::kGeForce4);
  for (const char* setting : {"vertex.units=8", "memory.channels=1"}) machine::set(machine, setting);
  const Trace trace = plane_of_several_draws(machine);
  const Rendered rendered = render(trace, render_options(machine));
  auto next = rendered.work.begin();
  const auto first = sim::estimate_sampled_beside(
      trace, [&]() -> const DrawWork& { return *next++; }, machine);
  ASSERT_FALSE(first.density.empty());
  HeatMaps once(trace, false), maps(trace, false);
  for (const DrawWork& work : rendered.work) once.add(work);
  int frames = 0;
  const FrameRun run =
      run_frame(trace, machine, Fidelity::sampled, {}, [&](const Frame&) { ++frames; }, {.heat_maps = &maps});
  const sim::Result timing = time_frame(trace, rendered.work, machine, Fidelity::sampled);
  EXPECT_EQ(run.timing->cycles, timing.cycles);
  EXPECT_EQ(run.timing->cycles_plus_minus, timing.cycles_plus_minus);
  EXPECT_NE(timing.cycles_plus_minus, first.result.cycles_plus_minus);
  EXPECT_EQ(frames, 1);
  ASSERT_EQ(run.heat_maps.size(), once.maps().size());
  for (std::size_t i = 0; i < run.heat_maps.size(); ++i)
    EXPECT_EQ(run.heat_maps[i].sum, once.maps()[i].sum) << run.heat_maps[i].name;
}

// The records of a rectangle, of which a draw may have thousands, are gone when the last unit has seen them.
TEST(RunFrame, CycleTakesNoMoreMemoryForMoreOfTheSame) {
  const Machine machine = machine::load(machine::kRadeon8500);
  const auto megabytes = [&](std::uint32_t rectangles) {
    const Trace trace = splatscope::testing::rectangles(256, rectangles);
    restart_peak_memory();
    const double before = peak_megabytes();
    EXPECT_GT(run_frame(trace, machine, Fidelity::cycle).rendered.counters.quads, 16384u * rectangles);
    return peak_megabytes() - before;
  };
  if (!restart_peak_memory()) GTEST_SKIP() << "the system does not tell the peak of the memory";
  const double few = megabytes(100), many = megabytes(300);
  if (kSanitized) return;  // which keep what is freed
  EXPECT_LT(many, few + 5) << "200 rectangles more have 26 MB of quads";
}

// Neither before nor behind: where the first picture is done, the timing has begun.
TEST(RunFrame, TimeBeginsWhileTheFunctionIsComputed) {
  struct Beginning final : sim::Observer {
    void begin(const sim::SimulatedMachine&) override { began.set_value(); }
    void booked(const sim::Unit&, std::uint32_t, sim::Cycle, sim::Cycle) override {}
    sim::Cycle sample(sim::Cycle) override { return sim::kNever; }
    void end(const sim::Result&) override { ended = true; }
    std::promise<void> began;
    std::atomic<bool> ended = false;
  } beginning;
  sim::Observer* const observers[] = {&beginning};
  const Machine machine = machine::load(machine::kRadeon8500);
  bool beside = false;
  const auto wait = [&](const Frame&) {
    const auto status = beginning.began.get_future().wait_for(std::chrono::seconds(20));
    beside = status == std::future_status::ready && !beginning.ended;
  };
  Trace trace = plane_of_several_draws(machine);
  run_frame(trace, machine, Fidelity::cycle, {}, wait, {.observers = observers});
  EXPECT_TRUE(beside);
  EXPECT_TRUE(beginning.ended);
}

// What is wrong with a trace is found by the thread of the function, and told by the one that waits.
TEST(RunFrame, AnErrorOfTheFunctionIsThrown) {
  const Machine machine = machine::load(machine::kRadeon8500);
  const traces::Scene scene = traces::parse_scene(
      "[surfels]\ngenerator = \"plane\"\ncolumns = 8\nrows = 8\n[frame]\nwidth = 32\nheight = 32\n"
      "[splatting]\nalgorithm = \"no-ewa\"\n",
      "plane");
  const Trace trace = traces::record(scene, machine.numbers).trace;
  const auto fails = [](const Frame&) { throw std::runtime_error("a full disk"); };
  for (const Fidelity fidelity : {Fidelity::cycle, Fidelity::throughput})
    EXPECT_THROW(run_frame(trace, machine, fidelity, {}, fails), std::runtime_error);
}

}  // namespace
}  // namespace splatscope::studies
