#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "../forked.h"
#include "model/testing/sanitized.h"

// Bad input of one kind, case by case: each ends with the right exit status, one clear line on standard
// error, and everything as it was, within 2 s of CPU and 1 GiB.
namespace splatscope::tests {

class BadInputs {
 public:
  BadInputs() = default;
  ~BadInputs() { testing::Test::RecordProperty("cases", count_); }  // --gtest_output=xml tells them
  BadInputs(const BadInputs&) = delete;
  BadInputs& operator=(const BadInputs&) = delete;

  const std::filesystem::path& path() const { return folder_.path(); }
  void file(const std::string& name, const std::string& text) { folder_.file(name, text); }
  int count() const { return count_; }

  // The input is wrong: exit 2.
  void refused(const std::string& what, const std::vector<std::string>& arguments) {
    run(what, arguments, {}, {2});
  }
  // The same for one that has printed what was right before.
  void refused_with_output(const std::string& what, const std::vector<std::string>& arguments) {
    prints_ = true;
    refused(what, arguments);
    prints_ = false;
  }
  // It is right.
  void used(const std::string& what, const std::vector<std::string>& arguments) {
    run(what, arguments, {}, {0});
  }
  // A cut may be a whole file: exit 2, or what is there is used.
  void refused_or_used(const std::string& what, const std::vector<std::string>& arguments) {
    run(what, arguments, {}, {2, 0});
  }
  // The input is right and cannot be written: exit 1.
  void fails(const std::string& what, const std::vector<std::string>& arguments, const Limits& limits) {
    prints_ = true;  // a line for each step, before the one that fails
    run(what, arguments, limits, {1});
    prints_ = false;
  }

  // All of `text` cut to every multiple of 64 bytes, given to `name` by turns.
  template <class Use>
  void cut(const std::string& name, const std::string& text, const Use& use) {
    constexpr std::size_t kStep = 64;
    for (std::size_t size = 0; size < text.size(); size += kStep) {
      file(name, text.substr(0, size));
      use(fmt::format("{} of {} bytes of {}", size, text.size(), name));
    }
  }

 private:
  void run(const std::string& what, const std::vector<std::string>& arguments, Limits limits,
           const std::vector<int>& statuses) {
    SCOPED_TRACE(fmt::format("{}: splatscope {}", what, fmt::join(arguments, " ")));
    ++count_;
    if (!kSanitized) limits.cpu_seconds = 2;
    const auto before = contents();
    Forked program(arguments, path(), limits);
    const Outcome outcome = program.outcome();
    EXPECT_TRUE(std::ranges::count(statuses, outcome.status)) << "status " << outcome.status << '\n'
                                                              << outcome.error;
    EXPECT_TRUE(kSanitized || program.used().peak_kilobytes < 1 << 20);
    if (outcome.status == 0) return;
    EXPECT_TRUE(prints_ || outcome.out.empty()) << outcome.out;
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_LT(outcome.error.size(), 1500u) << outcome.error;
    EXPECT_EQ(outcome.error.find("std::"), std::string::npos) << outcome.error;
    const bool shader = !arguments.empty() && arguments.front() == "shader";  // the rule that it breaks
    EXPECT_TRUE(outcome.status != 2 || shader || outcome.error.find("expected") != std::string::npos)
        << outcome.error;
    const auto after = contents();
    for (const auto& [path, text] : after) {
      const auto found = before.find(path);
      EXPECT_TRUE(found != before.end() && found->second == text) << path << " is new or another";
    }
    EXPECT_EQ(after.size(), before.size()) << "files are gone";
  }

  // Files with their text; of gigabytes of zeros the size says enough.
  std::map<std::filesystem::path, std::string> contents() const {
    constexpr std::uintmax_t kMostRead = 1 << 26;
    std::map<std::filesystem::path, std::string> texts;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path())) {
      std::string& text = texts[entry.path()];
      std::error_code error;  // of a link to itself
      if (!entry.is_regular_file(error)) continue;
      text = entry.file_size() > kMostRead ? std::to_string(entry.file_size()) : text_of(entry.path());
    }
    return texts;
  }

  ScratchFolder folder_;
  int count_ = 0;
  bool prints_ = false;
};

inline constexpr const char* kTinyScene =
    "[surfels]\ncolumns = 4\nrows = 4\n[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n"
    "[frame]\nwidth = 48\nheight = 32\n[capture]\nviews = 4\nframe_size = 32\n[splatting]\ntexture_length = "
    "8\n";

}  // namespace splatscope::tests
