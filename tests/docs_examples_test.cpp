#include <gtest/gtest.h>

#include "program.h"

// The examples of the documentation, run as a reader would: the blocks of a page that are marked "sh run",
// one after the other in one empty folder.
namespace splatscope::tests {
namespace {

std::vector<std::string> blocks_of(const std::filesystem::path& page) {
  std::vector<std::string> blocks;
  std::ifstream in(page);
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line == "```sh run") {
      inside = true;
      blocks.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back() += line + '\n';
    }
  }
  return blocks;
}

TEST(Documentation, ExamplesRun) {
  const std::filesystem::path docs = std::filesystem::path(SPLATSCOPE_SOURCE) / "docs";
  const std::string programs = std::filesystem::path(SPLATSCOPE_PROGRAM).parent_path().string();
  std::size_t run = 0;
  for (const auto& entry : std::filesystem::directory_iterator(docs)) {
    if (entry.path().extension() != ".md") continue;
    const ScratchFolder folder;
    for (const std::string& block : blocks_of(entry.path())) {
      folder.file("example.sh", "set -eu\n" + block);
      const std::string command = fmt::format("cd '{}' && PATH='{}':\"$PATH\" bash example.sh >said 2>&1",
                                              folder.path().string(), programs);
      EXPECT_EQ(0, std::system(command.c_str())) << entry.path() << ":\n"
                                                 << block << text_of(folder.path() / "said");
      ++run;
    }
  }
  EXPECT_GE(run, 8u);
}

// docs/units has what docs/unit_pages writes.
TEST(Documentation, UnitPagesAreWhatTheProgramPrints) {
  const std::filesystem::path source = SPLATSCOPE_SOURCE;
  const ScratchFolder folder;
  const std::string command = fmt::format("'{}' '{}' '{}'", (source / "docs/unit_pages").string(),
                                          SPLATSCOPE_PROGRAM, folder.path().string());
  ASSERT_EQ(0, std::system(command.c_str()));
  const std::vector<std::string> names = folder.names();
  EXPECT_GE(names.size(), 14u);
  for (const std::string& name : names) {
    EXPECT_EQ(text_of(folder.path() / name), text_of(source / "docs/units" / name))
        << "docs/units/" << name << ": run docs/unit_pages";
  }
  for (const auto& entry : std::filesystem::directory_iterator(source / "docs/units"))
    EXPECT_NE(names.end(), std::ranges::find(names, entry.path().filename().string())) << entry.path();
}

}  // namespace
}  // namespace splatscope::tests
