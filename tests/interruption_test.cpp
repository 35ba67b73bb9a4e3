#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "forked.h"

// Ctrl-C ends every long command soon, with complete files or none.
namespace splatscope::tests {
namespace {

using namespace std::chrono_literals;

// A second where nothing else runs; this much where the machine has other work to do.
constexpr auto kSoon = 10s;

// Each takes many seconds where nothing stops it.
const std::vector<std::vector<std::string>> kLong = {
    {"run", "checkerboard-ewa-per-surfel", "--fidelity", "referee", "--timeline", "t.json"},
    {"run", "large.toml", "--reference", "perspective"},
    {"sweep", "checkerboard-ewa-per-surfel", "--sweep", "vertex.units=1,2,3,4,5,6,7,8", "--cache", "cache"},
    {"record", "large.toml", "-o", "large.trace"},
    {"sample", "square.obj", "-n", "8000000", "-o", "s.ply"},
    {"run", "volume-head", "--fidelity", "throughput"},
    {"shader", "run", "--batch", "cases.jsonl"},
    {"study", "vertex-data"},
    {"reproduce", "table1"}};

// A mesh, a scene whose weights take long to capture, and many cases for the command that reads them.
void add_inputs(const ScratchFolder& folder, const std::vector<std::string>& command) {
  folder.file("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  std::string cases;
  if (std::ranges::count(command, "cases.jsonl") > 0)
    for (int i = 0; i < 500000; ++i) cases += "{\"program\": \"vs_1_1\\nmov oPos, v0\\n\"}\n";
  folder.file("cases.jsonl", cases);
  folder.file("large.toml",
              "[surfels]\ncolumns = 1500\nrows = 1500\n[capture]\nviews = 64\nframe_size = 2048\n"
              "[frame]\nwidth = 2048\nheight = 2048\n");
}

// Files that no command leaves but half-written: they have a hidden name while they are written.
std::vector<std::string> half_written(const std::filesystem::path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.front() == '.') found.push_back(name);
  }
  return found;
}

// Ended `after` it began, by `signal`.
void expect_stops(const std::vector<std::string>& command, std::chrono::milliseconds after, int signal) {
  SCOPED_TRACE(fmt::format("{} {}, after {} ms", command[0], command[1], after.count()));
  const ScratchFolder folder;
  add_inputs(folder, command);
  Forked program(command, folder.path());
  std::this_thread::sleep_for(after);
  program.signal(signal);
  const auto asked = std::chrono::steady_clock::now();
  const Outcome outcome = program.outcome();
  EXPECT_LT(std::chrono::steady_clock::now() - asked, kSoon);
  EXPECT_EQ(outcome.status, 128 + signal) << outcome.out << outcome.error;
  EXPECT_EQ(outcome.error, "splatscope: interrupted\n");
  EXPECT_EQ(half_written(folder.path()), std::vector<std::string>{});
}

TEST(Interruption, StopsEveryLongCommandAtOnce) {
  for (const auto& command : kLong) expect_stops(command, 50ms, SIGINT);
}

TEST(Interruption, StopsEveryLongCommandInItsMiddle) {
  for (const auto& command : kLong) expect_stops(command, 900ms, SIGINT);
}

TEST(Interruption, StopsForATerminationOrTheEndOfItsTerminal) {
  expect_stops(kLong[0], 300ms, SIGTERM);
  expect_stops(kLong[0], 300ms, SIGHUP);
}

}  // namespace
}  // namespace splatscope::tests
