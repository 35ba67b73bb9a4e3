#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "program.h"

// What the tests of the command line have in common.
namespace splatscope::tests {

// Exit 2 and exactly one line, which holds `part`.
inline void expect_refused(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_NE(outcome.error.find(part), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("expected"), std::string::npos) << outcome.error;
}

// By the names of what is in it.
inline std::map<std::string, std::string> texts_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    texts[entry.path().filename().string()] = entry.is_directory() ? "" : text_of(entry.path());
  return texts;
}

// The same of a command line that is refused before any work: all files are as they were. What it said.
inline std::string expect_refused(const ScratchFolder& folder, const std::vector<std::string>& arguments,
                                  const std::string& part) {
  const auto before = texts_in(folder.path());
  const Outcome outcome = run_program(arguments, folder.path());
  expect_refused(outcome, part);
  EXPECT_EQ(texts_in(folder.path()), before);
  return outcome.error;
}

inline constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\n";

inline constexpr const char* kSmallScene =
    "[surfels]\ncolumns = 16\nrows = 16\n[camera]\neye = [0, 6, 14]\ntarget = [0, 0, 0]\n"
    "[frame]\nwidth = 64\nheight = 48\n";

}  // namespace splatscope::tests
