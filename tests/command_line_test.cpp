#include "command_line.h"

// What scripts and users rely on: exit status, one line on standard error, and no half-written file. Of
// `run`: run_command_test.cpp; of what is refused before any work: refused_command_test.cpp.
namespace splatscope::tests {
namespace {

TEST(CommandLine, EveryCommandHasHelpWithAnExample) {
  const std::vector<std::vector<std::string>> commands = {{},
                                                          {"machine"},
                                                          {"scene"},
                                                          {"shader"},
                                                          {"trace"},
                                                          {"record"},
                                                          {"trace", "info"},
                                                          {"scene", "keys"},
                                                          {"machine", "list"},
                                                          {"machine", "show"},
                                                          {"machine", "units"},
                                                          {"shader", "check"},
                                                          {"shader", "count"},
                                                          {"shader", "assemble"},
                                                          {"shader", "disassemble"},
                                                          {"shader", "debug"},
                                                          {"shader", "run"},
                                                          {"sample"},
                                                          {"explain"},
                                                          {"volume"},
                                                          {"study"}};
  for (std::vector<std::string> command : commands) {
    const std::string name = command.empty() ? "run" : command[0];
    command.push_back("--help");
    const Outcome outcome = run_program(command);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out.find("Example: splatscope " + name), std::string::npos) << outcome.out;
  }
}

TEST(CommandLine, WrongUseIsExit2) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"no-such-command"},
                                                    {"study"},
                                                    {"study", "vertex-data", "--list"},
                                                    {"trace"},
                                                    {"trace", "info"},
                                                    {"scene", "keys", "--none"}}) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.error, "");
  }
}

TEST(CommandLine, TraceThatIsNone) {
  const ScratchFolder folder;
  expect_refused(folder, {"trace", "info", "none.trace"}, "none.trace: ");
  folder.file("a.trace", "no trace at all");
  expect_refused(folder, {"trace", "info", "a.trace"}, "a.trace: is no trace");
}

TEST(CommandLine, SampleMakesASceneOfAMesh) {
  const ScratchFolder folder;
  folder.file("square.obj", kSquare);
  const Outcome sampled =
      run_program({"sample", "square.obj", "-n", "123", "-o", "s.ply", "--quiet"}, folder.path());
  EXPECT_EQ(sampled.status, 0) << sampled.error;
  EXPECT_NE(sampled.out.find("s.ply: 123 surfels from 2 triangles, 1 left out"), std::string::npos)
      << sampled.out;
  folder.file("s.toml", "[surfels]\nfile = \"s.ply\"\n[frame]\nwidth = 16\nheight = 16\n");
  const Outcome drawn = run_program({"run", "s.toml", "--fidelity", "functional"}, folder.path());
  EXPECT_NE(drawn.out.find("123 surfels, none left out"), std::string::npos) << drawn.out << drawn.error;
}

TEST(CommandLine, SampleRefusesWhatItCannotUse) {
  const ScratchFolder folder;
  folder.file("square.obj", kSquare);
  expect_refused(folder, {"sample", "none.obj", "-o", "s.ply"}, "none.obj: ");
  expect_refused(folder, {"sample", "square.obj", "-o", "none/s.ply"}, "none/s.ply: ");
  expect_refused(folder, {"sample", "square.obj", "-o", "s.ply", "--pattern", "tartan"},
                 "tartan not in {own,plain,checker");
  expect_refused(folder, {"sample", "square.obj", "-o", "s.ply", "-n", "0"}, "-n: ");
  expect_refused(folder, {"sample", "square.obj", "-o", "s.ply", "--pattern-scale", "0.5"},
                 "--pattern-scale: without squares, stripes or spots");
  for (const std::string option : {"--shading", "--pattern-scale"})
    expect_refused(folder, {"sample", "square.obj", "-o", "s.ply", option, "nan"},
                   option + ": \"nan\", expected a number");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "s.ply"));
}

struct BadScene {
  const char* text;
  const char* error;  // after the scene's name
};

constexpr BadScene kBadScenes[] = {
    {"[frame]\nwidht = 5\n", ":2: unknown key \"widht\" in [frame], expected one of: width"},
    {"[lights]\n", ":1: unknown table \"lights\", expected one of: surfels"},
    {"[frame]\nwidth = \"wide\"\n", ":2: frame.width is 'wide', expected a whole number from 1 to 4096"},
    {"[frame]\nwidth = 5000\n", ":2: frame.width is 5000, expected a whole number from 1 to 4096"},
    {"[camera]\nfov_y_degrees = nan\n", ":2: camera.fov_y_degrees is nan, expected a number"},
    {"[frame]\nwidth = = 4\n", ":2: "},
    {"[surfels]\nfile = \"none.ply\"\n", "none.ply: cannot be read, expected a PLY file"},
};

TEST(CommandLine, WrongScenesLeaveNoTrace) {
  const ScratchFolder folder;
  expect_refused(folder, {"record", "none.toml", "-o", "a.trace"}, "none.toml: no such file");
  for (const BadScene& bad : kBadScenes) {
    folder.file("bad.toml", bad.text);
    expect_refused(folder, {"record", "bad.toml", "-o", "a.trace"}, bad.error);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"bad.toml"});
  }
}

TEST(CommandLine, UnwritableTraceIsNotedBeforeTheWork) {
  const ScratchFolder folder;
  const std::string scene = "checkerboard-no-ewa";
  expect_refused(folder, {"record", scene, "-o", "none/a.trace"}, "none/a.trace: cannot be written");
  expect_refused(run_program({"record", scene, "-o", folder.path().string()}), "is a folder, expected");
  EXPECT_TRUE(folder.names().empty());
}

TEST(CommandLine, RecordedTraceTellsWhatItHolds) {
  const ScratchFolder folder;
  folder.file(
      "points.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\nend_header\n"
      "0 0 0  0 0 1  1\n0 nan 0  0 0 1  1\n0 0 0  0 0 0  1\n");
  folder.file("points.toml",
              "[surfels]\nfile = \"points.ply\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n"
              "[frame]\nwidth = 64\nheight = 32\n");
  const Outcome recorded = run_program({"record", "points.toml", "-o", "points.trace"}, folder.path());
  EXPECT_EQ(recorded.status, 0) << recorded.error;
  EXPECT_EQ(recorded.out, "points.trace: 1 surfels, 2 left out (1 not finite, 1 without a normal)\n");
  EXPECT_EQ(recorded.error, "") << "no progress bar on a pipe";
  const Outcome info = run_program({"trace", "info", "points.trace"}, folder.path());
  EXPECT_EQ(info.status, 0) << info.error;
  EXPECT_NE(info.out.find("frame      64 x 32"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("draw 2 triangles, splat_ewa.vs"), std::string::npos) << info.out;
}

TEST(CommandLine, TraceInfoTellsAllThatATraceHolds) {
  const Outcome info = run_program({"trace", "info", SPLATSCOPE_SOURCE "/tests/traces/version_1.trace"});
  EXPECT_EQ(info.out,
            "frame      640 x 4096\n"
            "frames     1\n"
            "buffer     0: 100 bytes in AGP memory\n"
            "buffer     1: 14 bytes in video memory\n"
            "texture    0: 3 x 2, 8-bit alpha\n"
            "program    0: a.vs, 20 bytes\n"
            "program    1: b.ps, 31 bytes\n"
            "command    0: clear to r 0.25 g 0.5 b 0.75 a 1, depth 0.5\n"
            "command    1: draw 2 triangles, a.vs, b.ps, 20 bytes a vertex from AGP memory, texture 0, depth "
            "write\n"
            "command    2: normalize on the host\n");
}

TEST(CommandLine, MachinesAreListedAndShown) {
  const Outcome list = run_program({"machine", "list"});
  EXPECT_EQ(list.status, 0) << list.error;
  for (const std::string name : {"geforce4-ti4400", "radeon-8500"}) {
    EXPECT_NE(list.out.find(name), std::string::npos) << list.out;
    const Outcome shown = run_program({"machine", "show", name});
    EXPECT_EQ(shown.status, 0) << shown.error;
    EXPECT_NE(shown.out.find("vertex.units = "), std::string::npos) << shown.out;
  }
}

TEST(CommandLine, WrongMachinesAreRefused) {
  const ScratchFolder folder;
  expect_refused(run_program({"machine", "show", "voodoo"}), "voodoo");
  expect_refused(run_program({"machine", "show", "none.toml"}), "none.toml");
  folder.file("m.toml", "\n[vertex]\nunts = 2\n");
  expect_refused(folder, {"machine", "show", "m.toml"}, "m.toml:3: ");
  folder.file("m.toml", "[vertex]\nunits = true\n");
  expect_refused(folder, {"machine", "show", "m.toml"}, "m.toml:2: ");
  folder.file("m.toml", "[vertex]\nunits = 1000\n");
  expect_refused(folder, {"machine", "show", "m.toml"}, "m.toml:2: ");
}

TEST(CommandLine, ExplainTellsWhatMadeAPixel) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const Outcome pixel = run_program({"explain", "small.toml", "--pixel", "32,32"}, folder.path());
  EXPECT_EQ(pixel.status, 0) << pixel.error;
  EXPECT_NE(pixel.out.find("command 0: clear"), std::string::npos);
  const Outcome vertex = run_program({"explain", "small.toml", "--vertex", "0,3"}, folder.path());
  EXPECT_NE(vertex.out.find("end of the program"), std::string::npos) << vertex.error;
  folder.file("own.vs", "vs_1_1\nmov oPos, v3\n");
  const Outcome own = run_program({"explain", "small.toml", "--vertex", "0,2", "--program",
                                   "visibility.vs=own.vs", "--set", "vertex.units=1"},
                                  folder.path());
  EXPECT_NE(own.out.find("visibility.vs replaced by own.vs (1 slots, was 13)"), std::string::npos) << own.out;
  EXPECT_NE(own.out.find("oPos after  = (1, 1, 0, 1)"), std::string::npos) << own.out;
  expect_refused(folder, {"explain", "small.toml", "--pixel", "32"}, "--pixel");
  expect_refused(folder, {"explain", "small.toml", "--pixel", "4000,1"}, "--pixel");
  EXPECT_EQ(run_program({"explain", "small.toml"}, folder.path()).status, 2);
}

// The documentation holds what the program prints.
TEST(Documentation, IsWhatTheProgramPrints) {
  struct Generated {
    const char* page;
    std::vector<std::string> command;
  };
  for (const Generated& g : {Generated{"scene_files.md", {"scene", "keys"}},
                             Generated{"machines.md", {"machine", "show", "geforce4-ti4400", "--markdown"}},
                             Generated{"machines.md", {"machine", "show", "radeon-8500", "--markdown"}}}) {
    const Outcome outcome = run_program(g.command);
    EXPECT_EQ(outcome.status, 0);
    const std::string page = text_of(std::string(SPLATSCOPE_SOURCE) + "/docs/" + g.page);
    EXPECT_NE(page.find("-->\n" + outcome.out + "<!-- end -->"), std::string::npos)
        << "docs/" << g.page << " is not what splatscope prints: run docs/update";
  }
}

}  // namespace
}  // namespace splatscope::tests
