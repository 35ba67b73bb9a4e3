#include "studies/sweep.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <thread>

#include "model/error.h"
#include "model/processes.h"
#include "model/stop.h"
#include "model/testing/scratch_folder.h"
#include "studies/run_results.h"
#include "studies/work_cache.h"
#include "traces/output_files.h"
#include "traces/trace_file.h"

namespace splatscope::studies {
namespace {

// A folder of its own for each test, gone after it.
class SweepFiles : public ::testing::Test {
 protected:
  SweepFiles() {
    const traces::Scene scene = traces::parse_scene(
        "[surfels]\ngenerator = \"plane\"\ncolumns = 20\nrows = 20\n[frame]\nwidth = 64\nheight = 64\n"
        "[capture]\nviews = 2\nframe_size = 64\n",
        "plane");
    trace = traces::record(scene, machine.numbers).trace;
    traces::write_trace(trace, file);
  }

  ScratchFolder folder;
  std::filesystem::path file = folder / "plane.trace";
  Machine machine = machine::load(machine::kGeForce4);
  Trace trace;
};

void copy_fields(const TriangleWork& from, TriangleWork& to) {
  to.quad_count = from.quad_count;
  to.quads_passed = from.quads_passed;
  to.tile_count = from.tile_count;
  to.new_vertices = from.new_vertices;
  to.pieces = from.pieces;
  to.outcome = from.outcome;
}

void copy_fields(const QuadWork& from, QuadWork& to) {
  to.x = from.x;
  to.y = from.y;
  to.covered = from.covered;
  to.passed = from.passed;
  to.texel_block_count = from.texel_block_count;
}

constexpr std::size_t kHeaderBytes = 56;  // of a file of the cache

using Sweeps = SweepFiles;
using WorkCaches = SweepFiles;

TEST_F(Sweeps, EveryPointIsWhatARunOfItsOwnSays) {
  const Sweep sweep = run_sweep(
      file, machine, {{"vertex.units", {"1", "3"}}, {"memory.channels", {"1", "2", "4"}}}, Fidelity::cycle);
  ASSERT_EQ(sweep.points.size(), 6u);
  EXPECT_EQ(sweep.functions, 1u);
  for (const SweepPoint& point : sweep.points) {
    Machine changed = machine;
    for (const auto& [key, value] : point.settings) machine::set(changed, key + "=" + value);
    const FrameRun run = run_frame(trace, changed, Fidelity::cycle);
    EXPECT_EQ(point.results, timing_json(*run.timing));
    const Rate rate = rate_of(*run.timing);
    EXPECT_EQ(point.rate.fps, rate.fps);
    EXPECT_EQ(point.rate.bottleneck, rate.bottleneck);
    EXPECT_EQ(point.rate.share, rate.share);
  }
  EXPECT_FALSE(sweep.seed) << "no samples";
  const auto json = results_of(sweep, machine, Fidelity::cycle);
  EXPECT_EQ(json["programs"], programs_json(trace));
  EXPECT_EQ(json["points"][5]["set"]["vertex.units"], "3");
  EXPECT_EQ(json["points"][5]["set"]["memory.channels"], "4");
}

// It need fit together only once all of it is there; and does so before anything is run.
TEST_F(Sweeps, TheMachinesAreCheckedWithAllTheirParameters) {
  machine::assign(machine, "memory.interleave_bytes=4096");
  const auto sweep = [&](std::vector<std::string> rows) {
    return run_sweep(file, machine, {{"memory.row_bytes", std::move(rows)}}, Fidelity::cycle,
                     {.before_work = [](const Opened&) { FAIL() << "a machine is wrong"; }});
  };
  EXPECT_EQ(error_of([&] {
              sweep({"8192", "2048"});
            }),
            "--set: memory.interleave_bytes is 4096, expected at most memory.row_bytes (2048)");
  const Sweep good = run_sweep(file, machine, {{"memory.row_bytes", {"4096", "8192"}}}, Fidelity::throughput);
  EXPECT_EQ(good.points.size(), 2u);
}

TEST_F(Sweeps, TheFunctionIsComputedForEachOfItsFormats) {
  std::vector<double> told;
  const Sweep sweep =
      run_sweep(file, machine, {{"vertex.cache_entries", {"1", "18"}}, {"setup.latency", {"5", "6"}}},
                Fidelity::cycle, {}, [&](double fraction) { told.push_back(fraction); });
  EXPECT_EQ(sweep.functions, 2u);
  EXPECT_TRUE(std::ranges::is_sorted(told)) << "over both";
  EXPECT_EQ(told.back(), 1);
  EXPECT_NE(sweep.points[0].results, sweep.points[2].results);
}

TEST_F(Sweeps, ACacheServesLaterSweepsAndADamagedOneIsRebuilt) {
  const std::vector<SweptParameter> swept{{"vertex.units", {"1", "2"}}};
  const std::filesystem::path cache = folder / "cache";
  const auto sweep = [&](Fidelity fidelity = Fidelity::cycle) {
    return run_sweep(file, machine, swept, fidelity, {.cache = cache});
  };
  const Sweep first = sweep();
  EXPECT_EQ(first.functions, 1u);
  EXPECT_EQ(first.from_cache, 0u);
  const Sweep second = sweep();
  EXPECT_EQ(second.functions, 0u);
  EXPECT_EQ(second.from_cache, 1u);
  const auto host = results_of(second, machine, Fidelity::cycle)["host"];
  EXPECT_EQ(host["functions_computed"], 0);
  EXPECT_EQ(host["functions_from_cache"], 1);
  EXPECT_EQ(second.points[1].results, first.points[1].results);

  const std::filesystem::path stored = std::filesystem::directory_iterator(cache)->path();
  std::fstream(stored, std::ios::in | std::ios::out | std::ios::binary).seekp(1000).put('!');
  const Sweep third = sweep();
  EXPECT_EQ(third.functions, 1u);
  EXPECT_EQ(third.damaged, std::vector{stored});
  EXPECT_EQ(third.points[1].results, first.points[1].results);
  EXPECT_EQ(sweep().from_cache, 1u);

  const Sweep estimate = sweep(Fidelity::throughput);
  EXPECT_EQ(estimate.from_cache, 1u);
  EXPECT_EQ(estimate.points[1].results,
            run_sweep(file, machine, swept, Fidelity::throughput).points[1].results);
}

TEST_F(Sweeps, ACacheThatCannotBeWrittenCostsNoResult) {
  const std::vector<SweptParameter> swept{{"vertex.units", {"1", "2"}}};
  const std::filesystem::path cache = folder / "cache";
  const auto lose_the_folder = [&](const Opened&) { std::filesystem::remove_all(cache); };
  const Sweep sweep =
      run_sweep(file, machine, swept, Fidelity::cycle, {.cache = cache, .before_work = lose_the_folder});
  ASSERT_EQ(sweep.not_kept.size(), 1u);
  EXPECT_TRUE(sweep.not_kept[0].starts_with(cache.string() + "/")) << sweep.not_kept[0];
  EXPECT_EQ(sweep.points[1].results, run_sweep(file, machine, swept, Fidelity::cycle).points[1].results);
}

// JSON holds no infinity.
TEST(TimingJson, AFrameOfNoTimeHasNoRate) {
  Machine machine = machine::load(machine::kGeForce4);
  machine::set(machine, "host.command_nanoseconds=0");
  Trace trace;
  trace.width = trace.height = 4;
  const auto frames_of = [&](std::vector<Command> commands) {
    trace.commands = std::move(commands);
    return timing_json(time_frame(trace, {}, machine, Fidelity::throughput))["frames"];
  };
  const nlohmann::ordered_json nothing = {{"cycles", 0}, {"milliseconds", 0.0}, {"frames_per_second", 0.0}};
  EXPECT_EQ(frames_of({}), nlohmann::ordered_json::array({nothing}));
  const auto two = frames_of({Clear{}, Present{}, Present{}});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_GT(two[0]["frames_per_second"], 0);
  EXPECT_EQ(two[1], nothing);
}

TEST_F(Sweeps, WrongInputIsAUsersError) {
  EXPECT_THROW(swept_parameter("vertex.units"), UserError);
  EXPECT_THROW(swept_parameter("=1,2"), UserError);
  EXPECT_THROW(swept_parameter("vertex.units="), UserError);
  const auto error_of = [&](const char* text) {
    return splatscope::error_of([&] { run_sweep(file, machine, {swept_parameter(text)}, Fidelity::cycle); });
  };
  EXPECT_EQ(error_of("vertex.units=1,99").find("--sweep: vertex.units is out of range (99), expected"), 0u);
  for (const std::string text :
       {"vertex.units=1,,2", "vertex.units=1,2,", "vertex.units=,1", "vertex.units=,"}) {
    EXPECT_EQ(splatscope::error_of([&] { swept_parameter(text); }),
              "--sweep: \"" + text + "\" has an empty value, expected KEY=VALUE,VALUE,...");
  }
  EXPECT_THROW(run_sweep(file, machine, {{"vertex.units", {"1"}}}, Fidelity::functional), UserError);
}

TEST_F(Sweeps, ValuesMayStandInQuotes) {
  const auto settings_of = [&](const std::string& swept) {
    return run_sweep(file, machine, {swept_parameter(swept)}, Fidelity::throughput).points[0].settings;
  };
  EXPECT_EQ(settings_of("numbers.frame=\"half\""), settings_of("numbers.frame=half"));
  EXPECT_EQ(splatscope::error_of([&] { settings_of("vertex.units=\"1\""); }),
            "--sweep: vertex.units has the wrong type, expected an integer, 1 to 16");
}

TEST_F(Sweeps, ValuesAreThoseThatTheMachineHolds) {
  const auto points_of = [&](const char* swept) {
    return run_sweep(file, machine, {swept_parameter(swept)}, Fidelity::throughput).points;
  };
  const auto units = points_of("vertex.units=+1,0x2,1_0");
  ASSERT_EQ(units.size(), 3u);
  for (const auto& [point, value] : {std::pair{0, "1"}, {1, "2"}, {2, "10"}})
    EXPECT_EQ(units[static_cast<std::size_t>(point)].settings[0].second, value);
  const auto error_of = [&](const char* swept) { return splatscope::error_of([&] { points_of(swept); }); };
  EXPECT_EQ(error_of("vertex.units=1,2,+1"),
            "--sweep: vertex.units has 1, given as +1, twice, expected each value once");
  EXPECT_EQ(error_of("numbers.frame=half,\"half\""),
            "--sweep: numbers.frame has half, given as \"half\", twice, expected each value once");
  EXPECT_EQ(error_of("clock.core_megahertz=100,1e2"),
            "--sweep: clock.core_megahertz has 100, given as 1e2, twice, expected each value once");
}

TEST(SweptParameters, HaveTheirKeysOnceAndAlone) {
  const auto error_of = [](const std::vector<std::string>& swept, const std::vector<std::string>& set) {
    return splatscope::error_of([&] { swept_parameters(swept, set); });
  };
  EXPECT_EQ(error_of({"vertex.units=1,2", "memory.channels=1"}, {"vertex.threads=2"}), "no error");
  EXPECT_EQ(error_of({"vertex.units=1,2", "vertex.units=3"}, {}),
            "--sweep: vertex.units is given twice, expected all its values in one --sweep");
  EXPECT_EQ(error_of({"vertex.units=1,2"}, {"vertex.units=3"}),
            "--set: vertex.units is swept, expected its values in --sweep alone");
}

TEST_F(WorkCaches, TheKeyIsOfWhatTheWorkDependsOn) {
  const std::string key = work_key(trace, render_options(machine));
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key, work_key(traces::read_trace(file), render_options(machine)));
  std::set<std::string> keys{key};
  const auto expect_another = [&](const std::string& why, const Machine& changed) {
    EXPECT_TRUE(keys.insert(work_key(trace, render_options(changed))).second) << why;
  };
  for (const char* setting :
       {"vertex.cache_entries=17", "numbers.vertex_arithmetic=ieee", "numbers.color=unorm12",
        "numbers.combiner=float32", "numbers.frame=half", "numbers.frame_rounding=dither",
        "numbers.depth=float32", "numbers.subpixel_bits=8", "numbers.filter_bits=8",
        "numbers.reciprocal_bits=12"}) {
    Machine changed = machine;
    machine::set(changed, setting);
    expect_another(setting, changed);
  }
  Machine timed = machine;
  machine::set(timed, "memory.channels=1");
  EXPECT_EQ(key, work_key(trace, render_options(timed))) << "of its time alone";
  trace.buffers[0].bytes[5] ^= std::byte{1};
  expect_another("another trace", machine);
}

TEST_F(WorkCaches, WhatIsCutShortOrMoreThanAnyMemoryIsNotTaken) {
  const WorkCache cache(folder / "cache");
  const Rendered rendered = render(trace, {});
  cache.write("k", {rendered.work, rendered.counters});
  WorkStream stream;
  ASSERT_EQ(cache.read("k", trace, stream), WorkCache::Found::yes);
  ASSERT_EQ(stream.work.size(), rendered.work.size());
  EXPECT_EQ(stream.work[0].shaded_vertices, rendered.work[0].shaded_vertices);
  EXPECT_EQ(stream.work[0].quads.size(), rendered.work[0].quads.size());
  EXPECT_EQ(stream.counters.fragments, rendered.counters.fragments);
  EXPECT_EQ(cache.read("another", trace, stream), WorkCache::Found::no);
  const auto size = std::filesystem::file_size(cache.path_of("k"));
  for (const std::uintmax_t left : {std::uintmax_t{1} << 40, size - 1, size / 2, std::uintmax_t{24},
                                    std::uintmax_t{3}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(cache.path_of("k"), left);
    EXPECT_EQ(cache.read("k", trace, stream), WorkCache::Found::damaged) << left << " bytes";
  }
}

// The magic, the key, the size and the checksum are right, and what follows them is not a work stream.
TEST_F(WorkCaches, WhatIsOfAnotherLayoutIsNotTaken) {
  const WorkCache cache(folder / "cache");
  cache.write("k", {});
  const std::string magic_and_key = text_of(cache.path_of("k")).substr(0, 40);
  const std::string no_draws = text_of(cache.path_of("k")).substr(kHeaderBytes);
  ASSERT_GE(no_draws.size(), sizeof(std::uint64_t));
  const std::string draws_missing = no_draws.substr(0, no_draws.size() - 8) + std::string(8, '\x11');
  WorkStream stream;
  for (const std::string& body : {std::string(), std::string("x"), no_draws + "x", draws_missing}) {
    const std::uint64_t header[] = {body.size(), XXH64(body.data(), body.size(), 0)};
    std::ofstream(cache.path_of("k"), std::ios::binary)
        << magic_and_key << std::string(reinterpret_cast<const char*>(header), sizeof header) << body;
    EXPECT_EQ(cache.read("k", trace, stream), WorkCache::Found::damaged) << body.size() << " bytes";
  }
}

TEST_F(WorkCaches, WhatCannotBeOfTheTraceIsNotTaken) {
  const WorkCache cache(folder / "cache");
  const Rendered rendered = render(trace, {});
  ASSERT_FALSE(rendered.work[0].clear_tiles.empty());
  using Found = WorkCache::Found;
  const auto found_with = [&](auto change) {
    WorkStream stream{rendered.work, rendered.counters};
    change(stream.work[0]);
    cache.write("k", stream);
    return cache.read("k", trace, stream);
  };
  EXPECT_EQ(found_with([](DrawWork&) {}), Found::yes);
  using Change = void (*)(DrawWork&);
  const Change of_draws[] = {
      [](DrawWork& work) { work.sampled_runs_apart = 3; },
      [](DrawWork& work) { work.sampled_runs_apart = 0; },
      [](DrawWork& work) { ++work.command; },
      [](DrawWork& work) { work.triangles.pop_back(); },
      [](DrawWork& work) { work.shaded_vertices.pop_back(); },
      [](DrawWork& work) { work.quads.pop_back(); },
      [](DrawWork& work) { work.texel_blocks.push_back(0); },
      [](DrawWork& work) { work.clear_tiles[0].tile = 16 * 16; },
      [](DrawWork& work) { work.clear_tiles.back().triangle = 0xffffff; },
      [](DrawWork& work) { work.quads[0].x = 32; },
      [](DrawWork& work) { work.quads[0].y = 32; },
      [](DrawWork& work) { work.quads[0].covered = work.quads[0].passed = 16; },
      [](DrawWork& work) { work.quads[0].covered = 1, work.quads[0].passed = 3; },
      [](DrawWork& work) {
        work.quads[0].texel_block_count = 5;
        work.texel_blocks.resize(work.texel_blocks.size() + 5);
      },
  };
  for (std::size_t i = 0; i < std::size(of_draws); ++i)
    EXPECT_EQ(found_with(of_draws[i]), Found::damaged) << i;
  const auto triangle_with = [&](auto change) {
    return found_with([&](DrawWork& work) {
      change(*std::ranges::find_if(work.triangles, [](const TriangleWork& t) { return t.quads_passed > 0; }));
    });
  };
  EXPECT_EQ(triangle_with([](TriangleWork& t) { t.pieces = 9; }), Found::damaged);
  EXPECT_EQ(triangle_with([](TriangleWork& t) { t.pieces = 0, t.tile_count = 0; }), Found::damaged);
  EXPECT_EQ(triangle_with([](TriangleWork& t) { t.tile_count = 8 * 8 + 1; }), Found::damaged);
  EXPECT_EQ(triangle_with([](TriangleWork& t) { t.outcome = TriangleOutcome{6}; }), Found::damaged);
  EXPECT_EQ(found_with([](DrawWork& work) {  // their sum is right
              work.triangles[0].new_vertices = 4;
              work.shaded_vertices.resize(work.shaded_vertices.size() + 1);
            }),
            Found::damaged);

  WorkStream stream{rendered.work, rendered.counters};
  stream.work.pop_back();
  cache.write("k", stream);
  EXPECT_EQ(cache.read("k", trace, stream), Found::damaged);
}

TEST_F(WorkCaches, AFileUnderAnothersNameIsNotTaken) {
  const WorkCache cache(folder / "cache");
  const Rendered rendered = render(trace, {});
  cache.write("a", {rendered.work, rendered.counters});
  std::filesystem::copy(cache.path_of("a"), cache.path_of("b"));
  WorkStream stream;
  EXPECT_EQ(cache.read("a", trace, stream), WorkCache::Found::yes);
  EXPECT_EQ(cache.read("b", trace, stream), WorkCache::Found::damaged);
}

TEST_F(WorkCaches, AFolderInTheFilesPlaceIsAUsersError) {
  const WorkCache cache(folder / "cache");
  std::filesystem::create_directory(cache.path_of("k"));
  WorkStream stream;
  const std::string error = error_of([&] { cache.read("k", trace, stream); });
  EXPECT_TRUE(error.starts_with(cache.path_of("k").string() + ": ")) << error;
}

// No byte that nobody has written, so of whatever memory the stream stands in.
TEST_F(WorkCaches, TheSameStreamIsTheSameBytes) {
  const WorkCache cache(folder / "cache");
  const Rendered rendered = render(trace, {});
  const auto bytes_with = [&](const std::vector<DrawWork>& work) {
    cache.write("k", {work, rendered.counters});
    return text_of(cache.path_of("k"));
  };
  const std::string bytes = bytes_with(rendered.work);
  std::vector<DrawWork> elsewhere = rendered.work;
  const auto copy_into = [](const auto& from, auto& to) {  // value by value, into memory that is not zero
    std::memset(static_cast<void*>(to.data()), 0xff, to.size() * sizeof to[0]);
    for (std::size_t i = 0; i < to.size(); ++i) copy_fields(from[i], to[i]);
  };
  for (std::size_t i = 0; i < elsewhere.size(); ++i) {
    copy_into(rendered.work[i].triangles, elsewhere[i].triangles);
    copy_into(rendered.work[i].quads, elsewhere[i].quads);
  }
  EXPECT_TRUE(bytes == bytes_with(elsewhere));
  WorkStream stream;
  ASSERT_EQ(cache.read("k", trace, stream), WorkCache::Found::yes);
  EXPECT_TRUE(bytes == bytes_with(stream.work));
}

std::size_t threads_of(::pid_t process) {
  const std::filesystem::path threads = "/proc/" + std::to_string(process) + "/task";
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(threads), std::filesystem::directory_iterator()));
}

// Whatever threads the library has begun before.
TEST(Processes, ForkFromOneThreadAndWorkInOne) {
  using Control = oneapi::tbb::global_control;
  const Control two(Control::max_allowed_parallelism, 2);  // on a host with one core too
  const auto work = [] {
    oneapi::tbb::parallel_for(0, 100,
                              [](int) { std::this_thread::sleep_for(std::chrono::microseconds(50)); });
  };
  in_processes(1, 1, [](std::size_t) { return std::string(); });
  const std::size_t alone = threads_of(::getpid());  // a sanitizer may have one of its own
  for (int i = 0; i < 1000 && threads_of(::getpid()) == alone; ++i) work();
  EXPECT_GT(threads_of(::getpid()), alone);
  const auto answers = in_processes(4, 2, [&](std::size_t) {
    const std::size_t before = threads_of(::getpid());
    work();
    return fmt::format("{} more of {}", threads_of(::getpid()) - before, threads_of(::getppid()));
  });
  for (const std::string& answer : answers) EXPECT_EQ(answer, fmt::format("0 more of {}", alone));
  work();
}

TEST(Processes, AnswersComeInOrderAndAFailureIsThrown) {
  std::size_t last = 0;
  const auto answers = in_processes(
      7, 3, [](std::size_t i) { return std::string(i * 100000, static_cast<char>('a' + i)); },
      [&](std::size_t done) { last = done; });
  ASSERT_EQ(answers.size(), 7u);
  for (std::size_t i = 0; i < answers.size(); ++i)
    EXPECT_EQ(answers[i], std::string(i * 100000, static_cast<char>('a' + i)));
  EXPECT_EQ(last, 7u);
  EXPECT_TRUE(in_processes(0, 2, [](std::size_t) { return std::string("x"); }).empty());
  EXPECT_THROW(in_processes(4, 2,
                            [](std::size_t i) -> std::string {
                              if (i == 2) throw std::runtime_error("two");
                              return "x";
                            }),
               std::runtime_error);
  EXPECT_EQ(error_of([] {
              in_processes(2, 2,
                           [](std::size_t) -> std::string { throw UserError("a.toml", 3, "wrong: x"); });
            }),
            "a.toml:3: wrong: x");
  // It alone was asked to stop, and not by the parent.
  try {
    in_processes(2, 2, [](std::size_t) -> std::string { throw Interrupted(); });
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "a process ended early");
  }
  EXPECT_THROW(in_processes(4, 2, [](std::size_t i) -> std::string { return i == 1 ? ::_exit(3), "" : "x"; }),
               std::runtime_error);
}

// It ends the child, and never comes to the parent's functions in it.
TEST(Processes, AnExceptionThatNobodyCatchesEndsTheProcess) {
  const ScratchFolder folder;
  const pid_t parent = ::getpid();
  try {
    in_processes(1, 1, [](std::size_t) -> std::string { throw 1; });
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_STRNE(error.what(), "");
  } catch (int) {
    if (::getpid() != parent) {
      traces::write_file(folder / "escaped", std::string_view("x"));
      ::_exit(0);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "escaped"));
}

}  // namespace
}  // namespace splatscope::studies
