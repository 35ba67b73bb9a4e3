#include <sched.h>
#include <sys/mount.h>

#include <fstream>

#include "cases.h"

namespace splatscope::tests {
namespace {

// Commands that write to the folder `to`, from the input tiny.toml, mesh.obj and plain.vs.
std::vector<std::vector<std::string>> writers(const std::string& to) {
  return {{"run", "tiny.toml", "--out", to},
          {"run", "tiny.toml", "--fidelity", "functional", "--out", to},
          {"run", "tiny.toml", "--reference", "--out", to},
          {"run", "tiny.toml", "--out", "elsewhere", "--timeline", to + "/t.json"},
          {"run", "tiny.toml", "--out", "elsewhere", "--counters", to + "/c.csv", "--counters-every", "10"},
          {"record", "tiny.toml", "-o", to + "/t.trace"},
          {"sample", "mesh.obj", "-n", "2000", "-o", to + "/s.ply"},
          {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--out", to},
          {"shader", "assemble", "plain.vs", "-o", to + "/plain.bin"},
          {"shader", "disassemble", "plain.vs", "-o", to + "/plain.txt"},
          {"reproduce", "fig8", "--out", to}};
}

// Writes to it only what can be computed again: it need not be writable, if it is there.
std::vector<std::string> sweep_cached_in(const std::string& folder) {
  return {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--out", "elsewhere", "--cache", folder};
}

class Outputs : public BadInputs {
 public:
  Outputs() {
    file("tiny.toml", kTinyScene);
    file("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    file("plain.vs", text_of(std::string(SPLATSCOPE_SOURCE) + "/kernels/object_space_ewa/splat_plain.vs"));
    std::filesystem::create_directory(path() / "elsewhere");
    std::filesystem::create_directory(path() / "there");
  }
};

// Each file may have 64 bytes: the rest of a write beyond that fails, as on a full disk.
TEST(BadInputs, OutputBeyondTheDisk) {
  Outputs inputs;
  for (const auto& arguments : writers("there"))
    inputs.fails("64 bytes a file", arguments, {.file_bytes = 64});
}

TEST(BadInputs, StandardOutputBeyondTheDisk) {
  Outputs inputs;
  inputs.file("batch.jsonl", "{\"program\": \"vs_1_1\\nmov oPos, v0\\n\"}\n");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"machine", "list"},
                                             {"machine", "show", "radeon-8500"},
                                             {"scene", "keys"},
                                             {"--help"},
                                             {"run", "--help"},
                                             {"study", "--list"},
                                             {"shader", "count", "plain.vs"},
                                             {"shader", "disassemble", "plain.vs"},
                                             {"shader", "run", "--batch", "batch.jsonl"},
                                             {"explain", "tiny.toml", "--pixel", "20,20"}})
    inputs.fails("/dev/full", arguments, {.output = "/dev/full"});
}

// What was computed is written before that is said.
TEST(Output, IsWholeWhereStandardOutputIsFull) {
  const ScratchFolder folder;
  folder.file("tiny.toml", kTinyScene);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"reproduce", "fig8", "--out", "out"},
           {"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--out", "out"},
           {"run", "tiny.toml", "--out", "out"}}) {
    std::filesystem::remove_all(folder / "out");
    const Outcome outcome = Forked(arguments, folder.path(), {.output = "/dev/full"}).outcome();
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "splatscope: standard output: writing failed (is the disk full?)\n");
    EXPECT_TRUE(std::filesystem::exists(folder / "out/results.json")) << arguments[0];
    EXPECT_TRUE(std::filesystem::exists(folder / "out/report.html")) << arguments[0];
  }
}

TEST(BadInputs, OutputWhereTheFileSystemRefusesTheName) {
  Outputs inputs;
  for (const auto& arguments : writers(std::string(300, 'n'))) inputs.refused("300 letters", arguments);
  const auto loop = [&](const char* name) {
    std::filesystem::create_symlink(std::filesystem::path(name).filename(), inputs.path() / name);
  };
  for (const char* name : {"there/results.json", "there/t.trace", "there/s.ply", "there/plain.bin"})
    loop(name);
  loop("self");
  std::filesystem::create_symlink("nowhere/gone", inputs.path() / "lost");
  for (const char* link : {"self", "lost"}) {
    for (const auto& arguments : writers(link)) inputs.refused(link, arguments);
    inputs.refused(link, sweep_cached_in(link));
    inputs.refused(link, {"record", "tiny.toml", "-o", link});
  }
  inputs.refused("a link to itself", {"run", "tiny.toml", "--out", "there"});
  inputs.refused("a link to itself", {"reproduce", "fig8", "--out", "there"});
  inputs.refused("a link to itself", {"record", "tiny.toml", "-o", "there/t.trace"});
  inputs.refused("a link to itself", {"sample", "mesh.obj", "-n", "2000", "-o", "there/s.ply"});
  inputs.refused("a link to itself", {"shader", "assemble", "plain.vs", "-o", "there/plain.bin"});
}

TEST(BadInputs, OutputWhereNothingCanBeWritten) {
  Outputs inputs;
  inputs.file("taken", "a file where a folder is wanted");
  for (const char* place : {"/proc/self", "/proc/none", "/sys/kernel", "taken"}) {
    for (const auto& arguments : writers(place)) inputs.refused(place, arguments);
  }
  for (const char* place : {"/proc/none", "taken"}) inputs.refused(place, sweep_cached_in(place));
  inputs.used("/proc/self", sweep_cached_in("/proc/self"));
}

// A small file system in the place of a folder, which this process alone sees. `mounted` is false where that
// is not allowed: it takes root.
struct SmallDisk {
  SmallDisk(std::filesystem::path folder, const char* options, unsigned long flags)
      : place(std::move(folder)) {
    mounted = ::unshare(CLONE_NEWNS) == 0 &&
              ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
              ::mount("none", place.c_str(), "tmpfs", flags, options) == 0;
  }
  ~SmallDisk() {
    if (mounted) ::umount2(place.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  std::filesystem::path place;
  bool mounted = false;
};

TEST(BadInputs, OutputOnAFullDisk) {
  Outputs inputs;
  const SmallDisk disk(inputs.path() / "there", "size=4k", 0);
  if (!disk.mounted) GTEST_SKIP() << "no file system may be mounted here";
  std::ofstream(disk.place / "full") << std::string(4096, 'x');
  for (const auto& arguments : writers("there")) inputs.fails("a full disk", arguments, {});
  inputs.used("a full disk", sweep_cached_in("there"));
  EXPECT_EQ(inputs.count(), 12);
}

TEST(BadInputs, OutputOnAReadOnlyDisk) {
  Outputs inputs;
  const SmallDisk disk(inputs.path() / "there", "size=64k", MS_RDONLY);
  if (!disk.mounted) GTEST_SKIP() << "no file system may be mounted here";
  for (const auto& arguments : writers("there")) inputs.refused("read-only", arguments);
  inputs.used("read-only", sweep_cached_in("there"));
}

}  // namespace
}  // namespace splatscope::tests
