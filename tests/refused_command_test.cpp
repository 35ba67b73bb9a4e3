#include "command_line.h"

// Command lines that are refused before any work, and leave every file as it was.
namespace splatscope::tests {
namespace {

// As /dev/stdout is where the shell made a file of it: to write there by a new file would put it in the place
// of the link.
TEST(CommandLine, AStandardStreamIsNoPlaceForAFile) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  for (const char* stream : {"/proc/self/fd/1", "/proc/self/fd/2"}) {
    const auto link = folder.path() / "stream";
    std::filesystem::create_symlink(stream, link);
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"record", "small.toml", "-o", "stream"},
          {"run", "small.toml", "--counters", "stream", "--out", "o"}}) {
      const Outcome outcome = run_program(command, folder.path());
      expect_refused(outcome, "stream: is standard input, output or error of this run");
      EXPECT_TRUE(std::filesystem::is_symlink(link)) << command[0];
    }
    std::filesystem::remove(link);
  }
}

// The word that is wrong, and what may stand there.
TEST(CommandLine, AnUnknownCommandIsNamed) {
  const ScratchFolder folder;
  expect_refused(folder, {"rnu", "small.toml"}, "no command \"rnu\", expected reproduce, run, ");
  expect_refused(folder, {"shader", "chek", "x.vs"}, "no command \"chek\", expected check, count, ");
  expect_refused(folder, {"shader"}, "A subcommand is required");
}

// Parameters that fit together may come in any order, and some of them from a sweep.
TEST(CommandLine, TheOrderOfSettingsDoesNotMatter) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const std::string interleave = "memory.interleave_bytes=4096", row = "memory.row_bytes=4096";
  for (const std::vector<std::string>& settings :
       {std::vector<std::string>{"run", "--set", interleave, "--set", row},
        {"run", "--set", row, "--set", interleave},
        {"sweep", "--set", interleave, "--sweep", row + ",8192"},
        {"sweep", "--sweep", interleave + ",8192", "--sweep", "memory.row_bytes=8192"}}) {
    std::vector<std::string> arguments = settings;
    for (const char* more : {"--fidelity", "throughput", "--out", "o", "small.toml"})
      arguments.push_back(more);
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
  }
}

// What an option is about must be there, and of values a key has one.
TEST(CommandLine, OptionsWithoutAnEffectAreRefused) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const auto refused = [&](const char* command, const std::vector<std::string>& more,
                           const std::string& part) {
    std::vector<std::string> arguments{command, "small.toml", "--out", "o"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_refused(folder, arguments, part);
  };
  refused("run", {"--timeline-window", "1:2"}, "--timeline-window requires --timeline");
  refused("run", {"--pipeline-window", "1:2"}, "--pipeline-window requires --pipeline");
  refused("run", {"--counters-every", "10"}, "--counters-every requires --counters");
  refused("sweep", {"--sweep", "vertex.units=1", "--sweep", "vertex.units=2"}, "vertex.units is given twice");
  refused("sweep", {"--sweep", "vertex.units=1", "--set", "vertex.units=2"}, "vertex.units is swept");
  refused("sweep", {"--sweep", "vertex.units=99"}, "--sweep: vertex.units is out of range (99)");
  refused("run", {"--set", "memory.interleave_bytes=4096"},
          "--set: memory.interleave_bytes is 4096, expected");
  refused("sweep", {"--set", "memory.interleave_bytes=4096", "--sweep", "memory.row_bytes=4096,2048"},
          "--set: memory.interleave_bytes is 4096, expected at most memory.row_bytes (2048)");
}

TEST(CommandLine, WrongRunsAreRefusedAndLeaveNothing) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  folder.file("wrong.toml", "[surfel]\n");
  folder.file("taken", "a file where a folder is wanted");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    expect_refused(folder, arguments, part);
  };
  refused({"run", "wrong.toml", "--out", "made"}, "wrong.toml:1: ");
  refused({"run", "none.trace", "--out", "made"}, "none.trace: ");
  refused({"run", "small.toml", "--out", "taken"}, "taken: ");
  refused({"run", "small.toml", "--out", "taken/below"}, "taken/below: ");
  refused({"run", "small.toml", "--fidelity", "exact"}, "--fidelity: ");
  refused({"run", "small.toml", "--machine", "voodoo"}, "voodoo");
  refused({"run", "small.toml", "--set", "vertex.unts=2"}, "vertex.unts");
  refused({"run", "small.toml", "--set", "vertex.units=0"}, "vertex.units");
  refused({"reproduce", "table7"}, "table7");
  refused({"reproduce", "--out", "taken"}, "taken: ");
  refused({"study", "vertex-dates"}, "vertex-dates");
  refused({"study", "vertex-data", "--out", "taken"}, "taken: ");
}

// No file of a command line is written over another: exit 2 before any work, and all as it was.
TEST(CommandLine, FilesOfOneNameAreRefused) {
  const ScratchFolder folder;
  folder.file("in.toml", kSmallScene);
  folder.file("square.obj", kSquare);
  folder.file("a.vs", "vs_1_1\nmov oPos, v0\n");
  std::filesystem::create_hard_link(folder.path() / "in.toml", folder.path() / "hard.toml");
  folder.file("m.toml", "base = \"radeon-8500\"\n");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    expect_refused(folder, arguments, part);
  };
  refused({"record", "in.toml", "-o", "in.toml"}, "in.toml: is named by -o and by SCENE (in.toml)");
  refused({"record", "in.toml", "-o", "hard.toml"}, "hard.toml: is named by -o and by SCENE (in.toml)");
  refused({"record", "in.toml", "-o", "m.toml", "--machine", "m.toml"}, "by -o and by --machine");
  refused({"sample", "square.obj", "-o", "square.obj"}, "by -o and by MESH");
  refused({"shader", "assemble", "a.vs", "-o", "./a.vs"}, "by --out and by FILE (a.vs)");
  refused({"shader", "disassemble", "a.vs", "-o", "a.vs"}, "by --out and by FILE (a.vs)");
  refused({"run", "in.toml", "--out", "o", "--counters", "in.toml"}, "by --counters and by INPUT");
  refused({"run", "in.toml", "--out", "o", "--program", "splat_ewa.vs=a.vs", "--pipeline", "a.vs"},
          "by --pipeline and by --program");
  refused({"run", "in.toml", "--out", "o", "--counters", "same", "--timeline", "same"},
          "same: is named by --counters and by --timeline");
  for (const char* name : {"results.json", "frame.png", "overdraw.exr", "reference.png", "frame-012.png"})
    refused({"run", "in.toml", "--out", "o", "--timeline", std::string("o/") + name},
            "by --timeline and by a result in --out");
  folder.file("results.json", kSmallScene);
  refused({"sweep", "results.json", "--sweep", "vertex.units=1,2", "--out", "."},
          "by INPUT and by a result in --out");
  refused({"volume", "results.json", "--out", "."}, "by SCENE and by a result in --out");
}

}  // namespace
}  // namespace splatscope::tests
