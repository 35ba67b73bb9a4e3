#include <fstream>

#include "command_line.h"

namespace splatscope::tests {
namespace {

// Work that another build of the program computed may differ.
TEST(SweepCommand, AnotherBuildComputesTheWorkItself) {
  const ScratchFolder folder;
  folder.file("tiny.toml", "[surfels]\ncolumns = 4\nrows = 4\n[frame]\nwidth = 16\nheight = 16\n");
  const std::filesystem::path another = folder / "another";
  std::filesystem::copy(SPLATSCOPE_PROGRAM, another);
  std::ofstream(another, std::ios::app) << "x";
  const auto from_cache = [&](const std::string& program) {
    const Outcome outcome =
        run_program({"sweep", "tiny.toml", "--sweep", "vertex.units=1,2", "--cache", "cache", "--out", "out"},
                    folder.path(), program);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return results_in(folder / "out")["host"]["functions_from_cache"].get<int>();
  };
  EXPECT_EQ(from_cache(SPLATSCOPE_PROGRAM), 0);
  EXPECT_EQ(from_cache(SPLATSCOPE_PROGRAM), 1);
  EXPECT_EQ(from_cache(another.string()), 0);
}

}  // namespace
}  // namespace splatscope::tests
