#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "command_line.h"
#include "studies/testing/read_image.h"

namespace splatscope::tests {
namespace {

constexpr const char* kHead =
    "[volume]\ngenerator = \"head\"\nvoxels = [24, 24, 10]\nsurface_low = 0.6\nsurface_high = 1\n"
    "[frame]\nwidth = 48\nheight = 40\n";

TEST(VolumeCommand, DrawsAVolumeInEitherPrecision) {
  const ScratchFolder folder;
  folder.file("head.toml", kHead);
  studies::Image pictures[2];
  for (const std::string precision : {"single", "double"}) {
    const Outcome outcome =
        run_program({"volume", "head.toml", "--precision", precision, "--out", precision}, folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    const auto out = folder.path() / precision;
    const auto results = results_in(out);
    EXPECT_EQ(results["volume"]["size"], nlohmann::json({24, 24, 10}));
    const std::size_t splats = results["splats"], empty = results["volume"]["empty"];
    EXPECT_GT(splats, 500u);
    EXPECT_EQ(splats + empty, 24u * 24 * 10);
    pictures[precision == "double"] = studies::testing::read_image(out / "frame.exr");
    EXPECT_TRUE(std::filesystem::exists(out / "frame.png"));
  }
  EXPECT_GT(studies::psnr(pictures[0], pictures[1]), 50);  // the step of the table: kernels/reference/volume
}

// From within, most of it is behind the eye or beside the frame.
TEST(VolumeCommand, CountsWhatIsDrawnAsRunDoes) {
  const ScratchFolder folder;
  folder.file("shells.toml",
              "[volume]\ngenerator = \"shells\"\nvoxels = [32, 32, 32]\n"
              "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, -1]\n[frame]\nwidth = 64\nheight = 64\n");
  ASSERT_EQ(
      run_program({"run", "shells.toml", "--fidelity", "functional", "--out", "run"}, folder.path()).status,
      0);
  const auto machine = results_in(folder.path() / "run")["volume"];
  for (const std::string precision : {"single", "double"}) {
    const Outcome drawn =
        run_program({"volume", "shells.toml", "--precision", precision, "--out", precision}, folder.path());
    const auto results = results_in(folder.path() / precision);
    EXPECT_EQ(results["sheets"], machine["sheets"]) << precision;
    const int splats = results["splats"], left_out = results["left_out"];
    EXPECT_NEAR(splats, int{machine["splats"]}, splats / 50) << "run counts splats between pixels too";
    EXPECT_EQ(splats + left_out, int{machine["splats"]} + int{machine["left_out"]});
    EXPECT_NE(drawn.out.find(fmt::format("{} splats in {} sheets, {} left out\n", splats,
                                         int{results["sheets"]}, left_out)),
              std::string::npos)
        << drawn.out;
  }
}

TEST(VolumeCommand, SaysWhereNothingIsDrawnAndWhy) {
  const ScratchFolder folder;
  const std::string volume = "[frame]\nwidth = 8\nheight = 8\n[volume]\nvoxels = [4, 4, 4]\n";
  folder.file("away.toml", volume + "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 18]\n");
  folder.file("clear.toml", volume + "transfer = [{ value = 0, opacity = 0, color = [1, 1, 1] }]\n");
  folder.file("seen.toml", volume);
  const auto said = [&](const char* scene) {
    const Outcome outcome = run_program({"volume", scene, "--out", "o"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return outcome.out;
  };
  const std::string start = "warning: no splat is drawn, so the picture is its background: ";
  EXPECT_NE(said("away.toml")
                .find(start + "each is before the near plane, beyond the far plane, outside of the "
                              "picture, or without a finite footprint\n"),
            std::string::npos);
  EXPECT_NE(said("clear.toml").find(start + "no voxel has any opacity, or a cell of any size\n"),
            std::string::npos);
  EXPECT_EQ(said("seen.toml").find("warning"), std::string::npos);
}

TEST(VolumeCommand, RefusesWhatIsNoVolume) {
  const ScratchFolder folder;
  folder.file("plane.toml", "[surfels]\n");
  folder.file("head.toml", kHead);
  folder.file("nan.toml", "[volume]\nfile = \"a.nrrd\"\n");
  folder.file("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 9\n");
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
    return outcome.error;
  };
  EXPECT_EQ(refused({"volume", "plane.toml"}),
            "plane.toml: has no [volume], expected a scene with a volume\n");
  EXPECT_EQ(refused({"volume", "nan.toml"}), "a.nrrd:4: 2 sizes, expected three\n");
  folder.file("swan.toml", "\n[volume]\nprefilter = \"swan\"\n");
  EXPECT_EQ(refused({"record", "swan.toml", "-o", "swan.trace"}),
            "swan.toml:3: volume.prefilter is not \"ewa\", expected it, the only filter of the machine's "
            "programs\n");
}

TEST(VolumeCommand, RunsAVolumeOnTheMachine) {
  const ScratchFolder folder;
  folder.file("head.toml", kHead);
  const Outcome run =
      run_program({"run", "head.toml", "--fidelity", "throughput", "--reference"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_NE(run.out.find(" splats ("), std::string::npos) << run.out;
  const auto results = results_in(folder.path() / "out");
  EXPECT_GT(results["volume"]["flat_splats"], 100);
  EXPECT_GT(results["volume"]["splats"], results["volume"]["flat_splats"]);
  EXPECT_GT(results["frames"][0]["cycles"], 1000);
  EXPECT_GT(results["reference"]["psnr_decibels"], 36);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/reference.png"));
  expect_refused(folder, {"run", "head.toml", "--reference", "perspective"},
                 "perspective is a map of surfels, expected affine for a volume");
  // What is recorded draws the same.
  const Outcome recorded = run_program({"record", "head.toml", "-o", "head.trace"}, folder.path());
  ASSERT_EQ(recorded.status, 0) << recorded.error;
  EXPECT_TRUE(recorded.out.starts_with("head.trace: ")) << recorded.out;
  const Outcome again =
      run_program({"run", "head.trace", "--fidelity", "throughput", "--out", "again"}, folder.path());
  ASSERT_EQ(again.status, 0) << again.error;
  EXPECT_EQ(text_of(folder.path() / "again/frame.png"), text_of(folder.path() / "out/frame.png"));
}

}  // namespace
}  // namespace splatscope::tests
