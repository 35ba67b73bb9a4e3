#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "studies/image_io.h"
#include "traces/trace_file.h"

// What scripts and users rely on: exit status, one line on standard error, and no half-written file.
namespace splatscope::tests {
namespace {

// Exit 2 and exactly one line, which holds `part`.
void expect_refused(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_NE(outcome.error.find(part), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("expected"), std::string::npos) << outcome.error;
}

TEST(CommandLine, EveryCommandHasHelpWithAnExample) {
  const std::vector<std::vector<std::string>> commands = {{"record"},
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
    command.push_back("--help");
    const Outcome outcome = run_program(command);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out.find("Example: splatscope " + command[0]), std::string::npos) << outcome.out;
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
  expect_refused(run_program({"trace", "info", "none.trace"}, folder.path()), "none.trace: ");
  folder.file("a.trace", "no trace at all");
  expect_refused(run_program({"trace", "info", "a.trace"}, folder.path()), "a.trace: is no trace");
}

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\n";

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
  expect_refused(run_program({"sample", "none.obj", "-o", "s.ply"}, folder.path()), "none.obj: ");
  expect_refused(run_program({"sample", "square.obj", "-o", "none/s.ply"}, folder.path()), "none/s.ply: ");
  expect_refused(run_program({"sample", "square.obj", "-o", "s.ply", "--pattern", "tartan"}, folder.path()),
                 "tartan not in {own,plain,checker");
  expect_refused(run_program({"sample", "square.obj", "-o", "s.ply", "-n", "0"}, folder.path()), "-n: ");
  for (const std::string option : {"--shading", "--pattern-scale"})
    expect_refused(run_program({"sample", "square.obj", "-o", "s.ply", option, "nan"}, folder.path()),
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
  expect_refused(run_program({"record", "none.toml", "-o", "a.trace"}, folder.path()),
                 "none.toml: no such file");
  for (const BadScene& bad : kBadScenes) {
    folder.file("bad.toml", bad.text);
    expect_refused(run_program({"record", "bad.toml", "-o", "a.trace"}, folder.path()), bad.error);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"bad.toml"});
  }
}

TEST(CommandLine, UnwritableTraceIsNotedBeforeTheWork) {
  const ScratchFolder folder;
  const std::string scene = "checkerboard-no-ewa";
  expect_refused(run_program({"record", scene, "-o", "none/a.trace"}, folder.path()),
                 "none/a.trace: cannot be written");
  expect_refused(run_program({"record", scene, "-o", folder.path().string()}), "is a folder, expected");
  EXPECT_TRUE(folder.names().empty());
}

// Surfels left out are not among those whose normals and radii are estimated.
TEST(CommandLine, WhatPointsLackIsEstimatedAndCounted) {
  const ScratchFolder folder;
  folder.file(
      "points.ply",
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 nan 0\n");
  folder.file("s.toml", "[surfels]\nfile = \"points.ply\"\n[frame]\nwidth = 16\nheight = 16\n");
  const Outcome drawn =
      run_program({"run", "s.toml", "--fidelity", "functional", "--out", "out"}, folder.path());
  EXPECT_NE(drawn.out.find("4 surfels, 1 left out (1 not finite), 4 normals estimated, 4 radii estimated\n"),
            std::string::npos)
      << drawn.out << drawn.error;
  const auto surfels = nlohmann::json::parse(text_of(folder.path() / "out/results.json"))["surfels"];
  EXPECT_EQ(surfels["normals_estimated"], 4);
  EXPECT_EQ(surfels["radii_estimated"], 4);
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
  expect_refused(run_program({"machine", "show", "m.toml"}, folder.path()), "m.toml:3: ");
  folder.file("m.toml", "[vertex]\nunits = true\n");
  expect_refused(run_program({"machine", "show", "m.toml"}, folder.path()), "m.toml:2: ");
  folder.file("m.toml", "[vertex]\nunits = 1000\n");
  expect_refused(run_program({"machine", "show", "m.toml"}, folder.path()), "m.toml:2: ");
}

constexpr const char* kSmallScene =
    "[surfels]\ncolumns = 16\nrows = 16\n[camera]\neye = [0, 6, 14]\ntarget = [0, 0, 0]\n"
    "[frame]\nwidth = 64\nheight = 48\n";

TEST(CommandLine, RunWritesItsResults) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const Outcome outcome = run_program({"run", "small.toml", "--out", "a/b"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "") << "no progress bar on a pipe";
  for (const char* name : {"frame.png", "frame.exr", "depth.exr", "results.json"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "a/b" / name)) << name;
  const auto results = nlohmann::json::parse(text_of(folder.path() / "a/b/results.json"));
  EXPECT_EQ(results["machine"], "geforce4-ti4400");
  EXPECT_EQ(results["fidelity"], "cycle");
  const auto& frame = results["frames"].at(0);
  EXPECT_NEAR(frame["frames_per_second"].get<double>() * frame["milliseconds"].get<double>(), 1000, 1e-6);
  EXPECT_EQ(frame["event_hash"].get<std::string>().size(), 16u);
  for (const auto& unit : results["units"]) {
    const std::uint64_t booked = unit["busy"].get<std::uint64_t>() + unit["starved"].get<std::uint64_t>() +
                                 unit["blocked"].get<std::uint64_t>() + unit["idle"].get<std::uint64_t>();
    EXPECT_EQ(booked, frame["cycles"]) << unit;
  }
  const std::string report = text_of(folder.path() / "a/b/report.html");
  EXPECT_NE(report.find("Left out: texture, pixel and blend in 1 of 2 draws, as they write no colour."),
            std::string::npos);
}

TEST(CommandLine, RunWritesATimelineAndCounters) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  std::vector<std::string> run = {"run",        "small.toml", "--out",      "a",
                                  "--timeline", "t.json",     "--counters", "c.csv"};
  EXPECT_EQ(run_program(run, folder.path()).status, 0);
  EXPECT_GT(nlohmann::json::parse(text_of(folder.path() / "t.json")).at("traceEvents").size(), 100u);
  EXPECT_EQ(text_of(folder.path() / "c.csv").substr(0, 6), "cycle,");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a", "c.csv", "small.toml", "t.json"}));
  run.insert(run.end(), {"--fidelity", "functional"});
  expect_refused(run_program(run, folder.path()), "--fidelity");
}

// The folder for the results is made first, and goes again where the run fails.
TEST(CommandLine, ATimelineMayLieInANewFolder) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  std::vector<std::string> run{"run", "small.toml", "--out", "new/o", "--timeline", "new/o/t.json"};
  const Outcome outcome = run_program(run, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "new/o/t.json"));
  std::filesystem::remove_all(folder.path() / "new");
  run[1] = "none.toml";
  expect_refused(run_program(run, folder.path()), "none.toml");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"small.toml"});
}

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

// It is read once.
TEST(CommandLine, ASceneMayComeThroughAPipe) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const std::string command =
      fmt::format("cd {} && cat small.toml | {} run /dev/stdin --fidelity functional --out o >said",
                  folder.path().string(), SPLATSCOPE_PROGRAM);
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto results = nlohmann::json::parse(text_of(folder.path() / "o/results.json"));
  EXPECT_EQ(results["surfels"]["drawn"], 16 * 16);
}

// A folder holds one run: pictures that an earlier one wrote and this one does not go away, and nothing else.
TEST(CommandLine, ALaterRunTakesTheFolderOver) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  Trace frames;
  frames.width = frames.height = 4;
  frames.commands = {Clear{{1, 0, 0, 1}, 1}, Present{}, Clear{{0, 1, 0, 1}, 1}, Present{}};
  traces::write_trace(frames, folder.path() / "two.trace");
  const auto names = [&] {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "o"))
      found.push_back(entry.path().filename().string());
    std::ranges::sort(found);
    return found;
  };
  const std::vector<std::string> always{"depth.exr", "frame.exr", "frame.png", "report.html", "results.json"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), always.begin(), always.end());
    std::ranges::sort(more);
    return more;
  };
  ASSERT_EQ(run_program({"run", "two.trace", "--out", "o"}, folder.path()).status, 0);
  EXPECT_EQ(names(), with({"frame-000.png"}));
  ASSERT_EQ(
      run_program({"run", "small.toml", "--out", "o", "--reference", "--heat-maps"}, folder.path()).status,
      0);
  EXPECT_EQ(names(), with({"cycles_per_tile.exr", "depth_fails.exr", "difference.png", "overdraw.exr",
                           "reference.exr", "reference.png", "texel_fetches.exr"}));
  ASSERT_EQ(run_program({"run", "small.toml", "--out", "o"}, folder.path()).status, 0);
  EXPECT_EQ(names(), with({}));
  const std::vector<std::string> own{"frame-000.png", "frame-new.png", "overdraw.exr", "reference.png"};
  for (const std::string& name : own) folder.file("o/" + name, "the user's");
  ASSERT_EQ(run_program({"run", "small.toml", "--out", "o"}, folder.path()).status, 0);
  EXPECT_EQ(names(), with(own)) << "that no run wrote";
  for (const char* other : {"{\"files\": [\"../small.toml\", \"small.toml\", 7]}", "[]", "no JSON"}) {
    folder.file("o/results.json", other);
    ASSERT_EQ(run_program({"run", "../small.toml", "--out", "."}, folder.path() / "o").status, 0) << other;
    EXPECT_EQ(names(), with(own)) << other;
  }
}

TEST(CommandLine, AReferenceThatCoversNothingIsSaidToBeNone) {
  const ScratchFolder folder;
  folder.file("away.toml",
              "[surfels]\ncolumns = 4\nrows = 4\n[camera]\neye = [0, 6, 14]\ntarget = [0, 6, 28]\n"
              "[frame]\nwidth = 32\nheight = 32\n");
  const Outcome outcome = run_program(
      {"run", "away.toml", "--reference", "--fidelity", "functional", "--out", "o"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("  against the reference: no pixel is covered\n"), std::string::npos)
      << outcome.out;
  const std::string report = text_of(folder.path() / "o/report.html");
  EXPECT_NE(report.find("no pixel is covered"), std::string::npos);
  EXPECT_EQ(report.find("nan dB"), std::string::npos);
}

// A library of pictures that is not there is told from one that does not load.
TEST(CommandLine, PicturesWithoutTheirLibraryAreAnError) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const std::string program = (folder.path() / "splatscope").string();
  std::filesystem::copy_file(SPLATSCOPE_PROGRAM, program);
  const std::vector<std::string> run{"run", "small.toml", "--fidelity", "functional", "--out", "o"};
  const Outcome missing = run_program(run, folder.path(), program);
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.error.find(", expected it beside the program\n"), std::string::npos) << missing.error;
  folder.file("libopen_image_io_module.so", "no library");
  const Outcome broken = run_program(run, folder.path(), program);
  EXPECT_EQ(broken.status, 1);
  EXPECT_NE(broken.error.find("splatscope: OpenImageIO's libraries could not be loaded: "),
            std::string::npos);
  EXPECT_EQ(broken.error.find("beside the program"), std::string::npos) << broken.error;
}

TEST(CommandLine, AMeshWithoutANameIsRefused) {
  expect_refused(run_program({"sample", "", "-o", "s.ply"}), "MESH: \"\" names no file");
}

// So that a script may give all fidelities the same options.
TEST(CommandLine, EveryFidelityTakesASeed) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  for (const char* fidelity : {"functional", "throughput", "sampled", "cycle"}) {
    const Outcome outcome = run_program(
        {"run", "small.toml", "--seed", "7", "--fidelity", fidelity, "--out", "o"}, folder.path());
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
    expect_refused(run_program(arguments, folder.path()), part);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"small.toml"});
  };
  refused("run", {"--timeline-window", "1:2"}, "--timeline-window requires --timeline");
  refused("run", {"--pipeline-window", "1:2"}, "--pipeline-window requires --pipeline");
  refused("run", {"--counters-every", "10"}, "--counters-every requires --counters");
  refused("sweep", {"--sweep", "vertex.units=1", "--sweep", "vertex.units=2"}, "vertex.units is given twice");
  refused("sweep", {"--sweep", "vertex.units=1", "--set", "vertex.units=2"}, "vertex.units is swept");
  refused("sweep", {"--sweep", "vertex.units=99"}, "--sweep: vertex.units is out of range (99)");
}

TEST(CommandLine, ExplainTellsWhatMadeAPixel) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const Outcome pixel = run_program({"explain", "small.toml", "--pixel", "32,32"}, folder.path());
  EXPECT_EQ(pixel.status, 0) << pixel.error;
  EXPECT_NE(pixel.out.find("command 0: clear"), std::string::npos);
  const Outcome vertex = run_program({"explain", "small.toml", "--vertex", "0,3"}, folder.path());
  EXPECT_NE(vertex.out.find("end of the program"), std::string::npos) << vertex.error;
  expect_refused(run_program({"explain", "small.toml", "--pixel", "32"}, folder.path()), "--pixel");
  expect_refused(run_program({"explain", "small.toml", "--pixel", "4000,1"}, folder.path()), "--pixel");
  EXPECT_EQ(run_program({"explain", "small.toml"}, folder.path()).status, 2);
}

TEST(CommandLine, TraceOfASceneRunsAsTheScene) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  ASSERT_EQ(run_program({"record", "small.toml", "-o", "small.trace"}, folder.path()).status, 0);
  ASSERT_EQ(run_program({"run", "small.toml", "--out", "a"}, folder.path()).status, 0);
  ASSERT_EQ(run_program({"run", "small.trace", "--out", "b"}, folder.path()).status, 0);
  for (const char* name : {"frame.png", "frame.exr", "depth.exr"})
    EXPECT_TRUE(text_of(folder.path() / "a" / name) == text_of(folder.path() / "b" / name)) << name;
  const auto frames = [&](const char* run) {
    return nlohmann::json::parse(text_of(folder.path() / run / "results.json"))["frames"];
  };
  EXPECT_EQ(frames("a"), frames("b"));
}

// Red, then green, then the same again: two pictures before the last.
TEST(CommandLine, EveryFrameOfATraceIsWritten) {
  const ScratchFolder folder;
  Trace trace;
  trace.width = trace.height = 4;
  trace.commands = {Clear{{1, 0, 0, 1}, 1}, Present{}, Clear{{0, 1, 0, 1}, 1}, Present{}, Present{}};
  traces::write_trace(trace, folder.path() / "three.trace");
  for (const std::string fidelity : {"functional", "cycle"}) {
    const Outcome run =
        run_program({"run", "three.trace", "--out", "out", "--fidelity", fidelity}, folder.path());
    ASSERT_EQ(run.status, 0) << run.error;
    const auto frames = nlohmann::json::parse(text_of(folder.path() / "out/results.json"))["frames"];
    ASSERT_EQ(frames.size(), 3u);
    const char* names[] = {"frame-000.png", "frame-001.png", "frame.png"};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(frames[i]["picture"], names[i]);
      EXPECT_EQ(frames[i].contains("cycles"), fidelity == "cycle");
      const auto picture = studies::read_image(folder.path() / "out" / names[i]);
      EXPECT_EQ(picture.at(3, 3), (std::array<float, 4>{i == 0 ? 1.0f : 0.0f, i == 0 ? 0.0f : 1.0f, 0, 1}));
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/frame-002.png"));
    std::filesystem::remove_all(folder.path() / "out");
  }
}

TEST(CommandLine, WrongRunsAreRefusedAndLeaveNothing) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  folder.file("wrong.toml", "[surfel]\n");
  folder.file("taken", "a file where a folder is wanted");
  const auto before = folder.names();
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    expect_refused(run_program(arguments, folder.path()), part);
    EXPECT_EQ(folder.names(), before);
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
  folder.file("mesh.toml", "[surfels]\nfile = \"square.obj\"\n");
  folder.file("volume.toml", "[volume]\nfile = \"v.nrrd\"\n");
  folder.file("v.nrrd", "the scene's");
  folder.file("named.toml", "[volume]\nfile = \"results.json\"\n");
  folder.file("results.json", "the scene's");
  const auto before = folder.names();
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    expect_refused(run_program(arguments, folder.path()), part);
    EXPECT_EQ(folder.names(), before);
    EXPECT_EQ(text_of(folder.path() / "in.toml"), kSmallScene);
  };
  refused({"record", "in.toml", "-o", "in.toml"}, "in.toml: is named by -o and by SCENE (in.toml)");
  refused({"record", "in.toml", "-o", "hard.toml"}, "hard.toml: is named by -o and by SCENE (in.toml)");
  refused({"record", "in.toml", "-o", "m.toml", "--machine", "m.toml"}, "by -o and by --machine");
  refused({"sample", "square.obj", "-o", "square.obj"}, "by -o and by MESH");
  refused({"shader", "assemble", "a.vs", "-o", "./a.vs"}, "by --out and by FILE (a.vs)");
  refused({"shader", "disassemble", "a.vs", "-o", "a.vs"}, "by --out and by FILE (a.vs)");
  refused({"record", "mesh.toml", "-o", "square.obj"},
          "square.obj: is named by -o and by the scene (square.obj)");
  refused({"record", "volume.toml", "-o", "./v.nrrd"}, "by -o and by the scene (v.nrrd)");
  refused({"run", "mesh.toml", "--out", "o", "--counters", "square.obj"}, "by --counters and by the scene");
  refused({"volume", "named.toml", "--out", "."}, "by a result in --out and by the scene");
  refused({"sweep", "named.toml", "--sweep", "vertex.units=1,2", "--out", "."},
          "by a result in --out and by the scene");
  refused({"run", "in.toml", "--out", "o", "--counters", "in.toml"}, "by --counters and by INPUT");
  refused({"run", "in.toml", "--out", "o", "--program", "splat_ewa.vs=a.vs", "--pipeline", "a.vs"},
          "by --pipeline and by --program");
  refused({"run", "in.toml", "--out", "o", "--counters", "same", "--timeline", "same"},
          "same: is named by --counters and by --timeline");
  for (const char* name : {"results.json", "frame.png", "overdraw.exr", "reference.png", "frame-012.png"})
    refused({"run", "in.toml", "--out", "o", "--timeline", std::string("o/") + name},
            "by --timeline and by a result in --out");
  folder.file("results.json", kSmallScene);
  const std::string results = text_of(folder.path() / "results.json");
  expect_refused(
      run_program({"sweep", "results.json", "--sweep", "vertex.units=1,2", "--out", "."}, folder.path()),
      "by a result in --out and by INPUT");
  expect_refused(run_program({"volume", "results.json", "--out", "."}, folder.path()),
                 "by a result in --out and by SCENE");
  EXPECT_EQ(text_of(folder.path() / "results.json"), results);
}

// A surfel that cannot be drawn is counted; one that is hard to draw is drawn, and nothing is left in the
// frame but numbers.
TEST(CommandLine, ExtremeSurfelsLeaveAFiniteFrame) {
  const ScratchFolder folder;
  folder.file(
      "extreme.ply",
      "ply\nformat ascii 1.0\nelement vertex 10\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\nend_header\n"
      "nan 0 0  0 0 1  1\n"  // not finite
      "0 0 0  0 0 1  inf\n"  // not finite
      "0 0 0  0 0 1  0\n"    // radius 0
      "0 0 0  0 0 0  1\n"    // normal 0
      "0 0 9  0 0 1  1\n"    // behind the eye
      "0 0 5  0 0 1  1\n"    // on the eye
      "0 0 4  0 1 0  3\n"    // across the near plane
      "0 0 0  0 1 0  1\n"    // edge-on
      "1e30 1e30 -1e30  1 1 1  1e30\n"
      "0 0 0  1e-30 0 1e-30  1e-30\n");
  for (const std::string algorithm : {"no-ewa", "ewa-per-pixel", "ewa-per-surfel"}) {
    folder.file("extreme.toml",
                "[surfels]\nfile = \"extreme.ply\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n"
                "[frame]\nwidth = 64\nheight = 48\n[splatting]\nalgorithm = \"" +
                    algorithm + "\"\n");
    for (const std::string numbers : {"unorm8", "float32"}) {
      const Outcome outcome = run_program(
          {"run", "extreme.toml", "--set", "numbers.frame=" + numbers, "--out", "out"}, folder.path());
      ASSERT_EQ(outcome.status, 0) << outcome.error;
      const auto skipped =
          nlohmann::json::parse(text_of(folder.path() / "out/results.json"))["surfels"]["skipped"];
      EXPECT_EQ(skipped["not_finite"], 2);
      EXPECT_EQ(skipped["zero_radius"], 1);
      EXPECT_EQ(skipped["zero_normal"], 1);
      for (const char* name : {"out/frame.exr", "out/depth.exr"})
        for (const auto& pixel : studies::read_image(folder.path() / name).pixels)
          for (float channel : pixel) ASSERT_TRUE(std::isfinite(channel)) << name << ' ' << algorithm;
    }
  }
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
