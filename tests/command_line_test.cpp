#include <gtest/gtest.h>

#include <algorithm>

#include "program.h"

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
  const std::vector<std::vector<std::string>> commands = {{"trace", "info"}, {"scene", "keys"}};
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

// The user's guide holds what the program prints.
TEST(Documentation, SceneKeysAreThoseOfTheProgram) {
  const Outcome outcome = run_program({"scene", "keys"});
  EXPECT_EQ(outcome.status, 0);
  const std::string page = text_of(std::string(SPLATSCOPE_SOURCE) + "/docs/scene_files.md");
  EXPECT_NE(page.find("-->\n" + outcome.out + "<!-- end -->"), std::string::npos)
      << "docs/scene_files.md is not what `splatscope scene keys` prints";
}

}  // namespace
}  // namespace splatscope::tests
