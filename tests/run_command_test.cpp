#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <tuple>

#include "command_line.h"
#include "studies/testing/read_image.h"
#include "traces/trace_file.h"

// What `run` prints and writes.
namespace splatscope::tests {
namespace {

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
  const auto surfels = results_in(folder.path() / "out")["surfels"];
  EXPECT_EQ(surfels["normals_estimated"], 4);
  EXPECT_EQ(surfels["radii_estimated"], 4);
}

TEST(CommandLine, RunWritesItsResults) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const Outcome outcome = run_program({"run", "small.toml", "--out", "a/b"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "") << "no progress bar on a pipe";
  for (const char* name : {"frame.png", "frame.exr", "depth.exr", "results.json"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "a/b" / name)) << name;
  for (const auto& pixel : studies::testing::read_image(folder.path() / "a/b/frame.exr").pixels)
    ASSERT_EQ(pixel[3], 1) << "what the frame buffer holds there is no coverage";
  const auto results = results_in(folder.path() / "a/b");
  EXPECT_EQ(results["machine"], "geforce4-ti4400");
  EXPECT_EQ(results["fidelity"], "cycle");
  const auto& frame = results["frames"].at(0);
  EXPECT_NEAR(frame["frames_per_second"].get<double>() * frame["milliseconds"].get<double>(), 1000, 1e-6);
  EXPECT_EQ(frame["event_hash"].get<std::string>().size(), 16u);
  const auto& host = results["host"];  // function and timing, at any fidelity
  EXPECT_NEAR(host["cycles_per_second"].get<double>() * host["seconds"].get<double>(),
              frame["cycles"].get<double>(), 1e-6 * frame["cycles"].get<double>());
  for (const auto& unit : results["units"]) {
    const std::uint64_t booked = unit["busy"].get<std::uint64_t>() + unit["starved"].get<std::uint64_t>() +
                                 unit["blocked"].get<std::uint64_t>() + unit["idle"].get<std::uint64_t>();
    EXPECT_EQ(booked, frame["cycles"]) << unit;
  }
  const std::string report = text_of(folder.path() / "a/b/report.html");
  EXPECT_NE(report.find("Left out: texture, pixel and blend in 1 of 2 draws, as they write no colour."),
            std::string::npos);
  EXPECT_NE(report.find("Time. Each of the 2 vertex units was busy at least "), std::string::npos);
}

// A script that reads the results can tell what was run.
TEST(CommandLine, TheResultsSayWhatWasSet) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const auto results_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"small.toml", "--set", "memory.channels=2", "--set",
                                       "numbers.frame=half", "--fidelity", "sampled"});
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return results_in(folder.path() / arguments[2]);
  };
  const auto run = results_of({"run", "--out", "a", "--seed", "7"});
  EXPECT_EQ(run["set"], (nlohmann::json{{"memory.channels", "2"}, {"numbers.frame", "half"}}));
  EXPECT_EQ(run["seed"], 7);
  EXPECT_EQ(run["frames"][0]["cycles_plus_minus"], 0.0) << "short draws are simulated whole";
  const auto swept = results_of({"sweep", "--out", "b", "--sweep", "vertex.units=1,2"});
  EXPECT_EQ(swept["set"], run["set"]);
  EXPECT_EQ(swept["points"][0]["set"], (nlohmann::json{{"vertex.units", "1"}}));
}

TEST(CommandLine, ResultsAreWrittenWithoutAPlotter) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "", 1);
  const Outcome run = run_program({"run", "small.toml", "--out", "run"}, folder.path());
  const Outcome figure = run_program({"reproduce", "fig8", "--out", "figure"}, folder.path());
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(figure.status, 0) << figure.error;
  EXPECT_NE(figure.out.find("no fig8a.svg: the report says why\n"), std::string::npos) << figure.out;
  for (const auto& [out, last_heading] :
       {std::pair("run", "Configuration"), std::pair("figure", "The machines")}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / out / "results.json"));
    const std::string report = text_of(folder.path() / out / "report.html");
    EXPECT_NE(report.find("No curves of "), std::string::npos);
    EXPECT_NE(report.find("gnuplot failed"), std::string::npos);
    EXPECT_NE(report.find(last_heading), std::string::npos);
  }
}

TEST(CommandLine, AFolderOfTemporaryFilesMayHaveAnyName) {
  const ScratchFolder folder;
  const auto odd = folder.path() / "it's $HOME";
  std::filesystem::create_directory(odd);
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before ? before : "";
  ::setenv("TMPDIR", odd.c_str(), 1);
  const Outcome figure = run_program({"reproduce", "fig8", "--out", "figure"}, folder.path());
  before ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
  EXPECT_EQ(figure.status, 0) << figure.error;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "figure/fig8a.svg")) << figure.out;
}

// Names of files are bytes, and JSON is UTF-8: what it cannot hold is replaced.
TEST(CommandLine, ASceneMayHaveANameThatIsNoText) {
  const ScratchFolder folder;
  const std::string name = "sc\xe9ne.toml", shown = "sc\xef\xbf\xbdne";
  folder.file(name, kSmallScene);
  const auto input_of = [&](const char* out) -> std::string {
    return results_in(folder.path() / out)["input"];
  };
  const Outcome ran = run_program({"run", name, "--fidelity", "throughput", "--out", "a"}, folder.path());
  EXPECT_EQ(ran.status, 0) << ran.error;
  EXPECT_EQ(input_of("a"), shown);
  const Outcome swept =
      run_program({"sweep", name, "--fidelity", "throughput", "--sweep", "vertex.units=1,2", "--out", "b"},
                  folder.path());
  EXPECT_EQ(swept.status, 0) << swept.error;
  EXPECT_EQ(input_of("b"), shown);
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
  expect_refused(folder, run, "--fidelity");
}

TEST(CommandLine, AWindowAfterTheRunIsSaidToShowNothing) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const auto said = [&](const std::string& window) {
    const Outcome outcome =
        run_program({"run", "small.toml", "--out", "a", "--timeline", "t.json", "--pipeline", "p.kanata",
                     "--timeline-window", window, "--pipeline-window", window},
                    folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return outcome.out;
  };
  const std::string none = said("999999999:9999999999");
  const auto cycles = results_in(folder.path() / "a")["frames"][0]["cycles"];
  for (const auto& [what, option] :
       {std::pair{"timeline", "--timeline-window"}, {"pipeline log", "--pipeline-window"}})
    EXPECT_NE(none.find(fmt::format(
                  "  warning: the {} is empty: the run ended at cycle {}, before the first of {}\n", what,
                  cycles.get<std::uint64_t>(), option)),
              std::string::npos)
        << none;
  EXPECT_EQ(said("10:9999999999").find("warning"), std::string::npos);
  const auto from = [&](std::uint64_t first) { return said(fmt::format("{}:9999999999", first)); };
  EXPECT_NE(from(cycles).find("warning"), std::string::npos) << "the last is one before";
  EXPECT_EQ(from(cycles.get<std::uint64_t>() - 1).find("warning"), std::string::npos);
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
  expect_refused(folder, run, "none.toml");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"small.toml"});
}

// It is read once.
TEST(CommandLine, ASceneMayComeThroughAPipe) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  const std::string command =
      fmt::format("cd {} && cat small.toml | {} run /dev/stdin --fidelity functional --out o >said",
                  folder.path().string(), SPLATSCOPE_PROGRAM);
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto results = results_in(folder.path() / "o");
  EXPECT_EQ(results["surfels"]["drawn"], 16 * 16);
}

void write_two_frames(const std::filesystem::path& path) {
  Trace frames;
  frames.width = frames.height = 4;
  frames.commands = {Clear{{1, 0, 0, 1}, 1}, Present{}, Clear{{0, 1, 0, 1}, 1}, Present{}};
  traces::write_trace(frames, path);
}

// A folder holds one run: pictures that an earlier one wrote and this one does not go away, and nothing else.
TEST(CommandLine, ALaterRunTakesTheFolderOver) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  write_two_frames(folder.path() / "two.trace");
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
  const auto plain = run_program({"run", "small.toml", "--out", "o"}, folder.path());
  ASSERT_EQ(plain.status, 0);
  EXPECT_EQ(names(), with({}));
  EXPECT_NE(plain.out.find("  depth.exr, frame.exr, frame.png, report.html, results.json in o\n"),
            std::string::npos)
      << plain.out;
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

// The new results stand in the folder, or the old ones: never both.
TEST(CommandLine, ARunThatFailsLeavesTheFolderAsItWas) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  write_two_frames(folder.path() / "two.trace");
  ASSERT_EQ(run_program({"run", "small.toml", "--out", "o"}, folder.path()).status, 0);
  auto before = texts_in(folder.path() / "o");
  const std::string full_disk =
      fmt::format("cd {} && (trap '' XFSZ; ulimit -f 20; {} run two.trace --out o) 2>said",
                  folder.path().string(), SPLATSCOPE_PROGRAM);
  EXPECT_NE(std::system(full_disk.c_str()), 0);
  EXPECT_NE(text_of(folder.path() / "said").find("is the disk full?"), std::string::npos);
  EXPECT_TRUE(before == texts_in(folder.path() / "o"));
  for (const char* taken : {"frame-000.png", "frame.png", "report.html"}) {
    std::filesystem::remove(folder.path() / "o" / taken);
    std::filesystem::create_directory(folder.path() / "o" / taken);
    before = texts_in(folder.path() / "o");
    expect_refused(folder, {"run", "two.trace", "--out", "o"},
                   fmt::format("o/{}: is a folder, expected a place for a file", taken));
    EXPECT_TRUE(before == texts_in(folder.path() / "o")) << taken;
    std::filesystem::remove(folder.path() / "o" / taken);
  }
}

// Whatever command wrote into a folder, the next one takes it over.
TEST(CommandLine, EveryCommandListsItsFilesAndRemovesAnEarlierOnes) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  folder.file("volume.toml", "[volume]\nvoxels = [4, 4, 4]\n[frame]\nwidth = 16\nheight = 16\n");
  std::filesystem::create_directory(folder.path() / "o");
  folder.file("o/own.png", "the user's");
  const std::vector<std::vector<std::string>> commands{
      {"run", "small.toml", "--out", "o"},
      {"sweep", "small.toml", "--fidelity", "throughput", "--sweep", "vertex.units=1,2", "--out", "o"},
      {"volume", "volume.toml", "--out", "o"},
      {"reproduce", "fig8", "--out", "o"}};
  for (std::size_t i = 0; i < 2 * commands.size(); ++i) {
    const auto& command = commands[i % commands.size()];
    const Outcome outcome = run_program(command, folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    const auto results = results_in(folder.path() / "o");
    std::vector<std::string> listed = results["files"], found;
    listed.emplace_back("own.png");
    std::ranges::sort(listed);
    for (const auto& [name, text] : texts_in(folder.path() / "o")) found.push_back(name);
    EXPECT_EQ(listed, found) << command[0];
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
  EXPECT_NE(
      outcome.out.find("  warning: no triangle covers a pixel, so nothing is drawn and the picture is what "
                       "it was cleared to\n"),
      std::string::npos)
      << outcome.out;
  const std::string report = text_of(folder.path() / "o/report.html");
  EXPECT_NE(report.find("no pixel is covered"), std::string::npos);
  EXPECT_EQ(report.find("nan dB"), std::string::npos);
}

// In a frame so small that every pixel is near an edge there are pixels inside the silhouette all the same.
TEST(CommandLine, HolesAreSaidWhereNoPixelIsOffEdges) {
  const ScratchFolder folder;
  folder.file("tiny.toml",
              "[surfels]\ncolumns = 16\nrows = 16\n[camera]\neye = [0, 6, 14]\ntarget = [0, 0, 0]\n"
              "[frame]\nwidth = 8\nheight = 8\n");
  const Outcome outcome = run_program(
      {"run", "tiny.toml", "--reference", "--fidelity", "functional", "--out", "o"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.out.find("off edges"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("pixels inside the silhouette are holes"), std::string::npos) << outcome.out;
}

// Only textures need the library that reads any format. One that is not there is told from one that does not
// load.
TEST(CommandLine, TexturesWithoutTheirLibraryAreAnError) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  folder.file("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
  folder.file("m.mtl", "newmtl a\nmap_Kd t.png\n");
  folder.file("t.png", "no picture");
  const std::string program = (folder.path() / "splatscope").string();
  std::filesystem::copy_file(SPLATSCOPE_PROGRAM, program);
  const Outcome plain =
      run_program({"run", "small.toml", "--fidelity", "functional", "--out", "o"}, folder.path(), program);
  EXPECT_EQ(plain.status, 0) << plain.error;
  const std::vector<std::string> sample{"sample", "m.obj", "-n", "10", "-o", "s.ply"};
  const Outcome missing = run_program(sample, folder.path(), program);
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.error.find(", expected it beside the program\n"), std::string::npos) << missing.error;
  folder.file("libopen_image_io_module.so", "no library");
  const Outcome broken = run_program(sample, folder.path(), program);
  EXPECT_EQ(broken.status, 1);
  EXPECT_NE(broken.error.find("splatscope: OpenImageIO's libraries could not be loaded: "),
            std::string::npos);
  EXPECT_EQ(broken.error.find("beside the program"), std::string::npos) << broken.error;
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

// What the fidelity promises of a frame of Table 1, that is large enough to be sampled.
TEST(CommandLine, ASampledFrameIsNearTheCyclesAndGoesByItsSeed) {
  const ScratchFolder folder;
  const auto frame = [&](const std::vector<std::string>& how) {
    std::vector<std::string> arguments{"run", "checkerboard-no-ewa", "--out", "o", "--fidelity"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return results_in(folder.path() / "o")["frames"].at(0);
  };
  const auto cycles = frame({"cycle"})["cycles"].get<double>();
  const auto first = frame({"sampled", "--seed", "1"});
  const auto second = frame({"sampled", "--seed", "2"});
  for (const auto& sampled : {first, second}) {
    EXPECT_NEAR(sampled["cycles"].get<double>(), cycles, 0.02 * cycles);
    EXPECT_GT(sampled["cycles_plus_minus"].get<double>(), 0);
    EXPECT_LT(sampled["cycles_plus_minus"].get<double>(), 0.02 * cycles);
  }
  EXPECT_EQ(frame({"sampled", "--seed", "1"})["cycles"], first["cycles"]);
  EXPECT_NE(second["cycles"], first["cycles"]);
}

TEST(CommandLine, TraceOfASceneRunsAsTheScene) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  ASSERT_EQ(run_program({"record", "small.toml", "-o", "small.trace"}, folder.path()).status, 0);
  ASSERT_EQ(run_program({"run", "small.toml", "--out", "a"}, folder.path()).status, 0);
  ASSERT_EQ(run_program({"run", "small.trace", "--out", "b"}, folder.path()).status, 0);
  for (const char* name : {"frame.png", "frame.exr", "depth.exr"})
    EXPECT_TRUE(text_of(folder.path() / "a" / name) == text_of(folder.path() / "b" / name)) << name;
  const auto frames = [&](const char* run) { return results_in(folder.path() / run)["frames"]; };
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
    const auto frames = results_in(folder.path() / "out")["frames"];
    ASSERT_EQ(frames.size(), 3u);
    const char* names[] = {"frame-000.png", "frame-001.png", "frame.png"};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(frames[i]["picture"], names[i]);
      EXPECT_EQ(frames[i].contains("cycles"), fidelity == "cycle");
      const auto picture = studies::testing::read_image(folder.path() / "out" / names[i]);
      EXPECT_EQ(picture.at(3, 3), (std::array<float, 4>{i == 0 ? 1.0f : 0.0f, i == 0 ? 0.0f : 1.0f, 0, 1}));
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/frame-002.png"));
    std::filesystem::remove_all(folder.path() / "out");
  }
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
      const auto skipped = results_in(folder.path() / "out")["surfels"]["skipped"];
      EXPECT_EQ(skipped["not_finite"], 2);
      EXPECT_EQ(skipped["zero_radius"], 1);
      EXPECT_EQ(skipped["zero_normal"], 1);
      for (const char* name : {"out/frame.exr", "out/depth.exr"})
        for (const auto& pixel : studies::testing::read_image(folder.path() / name).pixels)
          for (float channel : pixel) ASSERT_TRUE(std::isfinite(channel)) << name << ' ' << algorithm;
    }
  }
}

// A splat of sigma 10 is under one step of 8 bits at its centre: 1/(200 pi).
TEST(CommandLine, ACaptureThatSeesNothingIsWarnedOf) {
  const ScratchFolder folder;
  folder.file("small.toml", kSmallScene);
  folder.file("faint.toml", kSmallScene + std::string("[splatting]\nsigma = 10\n"));
  const auto said = [&](const char* scene) {
    return run_program({"run", scene, "--fidelity", "functional", "--out", "out"}, folder.path()).out;
  };
  const auto weights = [&] {
    const auto surfels = results_in(folder.path() / "out")["surfels"];
    return std::tuple(surfels["weights_captured"].get<int>(), surfels["weights_by_default"].get<int>(),
                      surfels["weights_outside_box"].get<int>());
  };
  const std::string faint = said("faint.toml");
  EXPECT_EQ(weights(), std::tuple(0, 256, 0));
  const std::string small = said("small.toml");
  EXPECT_EQ(weights(), std::tuple(256, 0, 0));
  EXPECT_NE(faint.find("weights: 0 captured, 0 of them a vertex; 256 seen from no view"), std::string::npos)
      << faint;
  EXPECT_NE(faint.find("warning: no view of the capture shows a surfel"), std::string::npos) << faint;
  EXPECT_NE(small.find("weights: 256 captured"), std::string::npos) << small;
  EXPECT_EQ(small.find("warning"), std::string::npos) << small;
}

}  // namespace
}  // namespace splatscope::tests
