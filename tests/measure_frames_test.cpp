#include <gtest/gtest.h>

#include "command_line.h"

// The script that measures whole frames says what it measured as JSON, or nothing.
namespace splatscope::tests {
namespace {

const std::string kScript = std::string(SPLATSCOPE_SOURCE) + "/tests/measure_frames";

TEST(MeasureFrames, PrintsJsonOfEveryFidelity) {
  const ScratchFolder folder;
  folder.file("a \"tiny\\new\".toml",
              "[surfels]\ncolumns = 4\nrows = 4\n[frame]\nwidth = 16\nheight = 16\n[capture]\nviews = 1\n");
  const Outcome outcome = run_program(
      {"--rounds", "2", "--scene", "a \"tiny\\new\".toml", SPLATSCOPE_PROGRAM, SPLATSCOPE_PROGRAM},
      folder.path(), kScript);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto measured = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(measured["scene"], "a \"tiny\\new\".toml");
  EXPECT_EQ(measured["rounds"], 2);
  for (const char* fidelity :
       {"functional", "functional_one_core", "throughput", "sampled", "cycle", "referee"}) {
    EXPECT_GT(measured["seconds"][fidelity]["least"], 0) << fidelity;
    EXPECT_GT(measured["ratios_of_other_program"][fidelity]["median"], 0) << fidelity;
  }
  EXPECT_GT(measured["referee_to_cycle"]["median"], 0);
}

TEST(MeasureFrames, RefusesWhatItDoesNotKnow) {
  const std::vector<std::vector<std::string>> wrong = {{"--rounds", "x"}, {"--rounds", "0"}, {"--rounds"},
                                                       {"--scene"},       {"--fast"},        {"no/program"}};
  for (const auto& arguments : wrong) {
    const ScratchFolder folder;
    expect_refused(run_program(arguments, folder.path(), kScript), "measure_frames: ");
  }
}

}  // namespace
}  // namespace splatscope::tests
