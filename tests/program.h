#pragma once

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// Runs the program as a user does, for tests.
namespace splatscope::tests {

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// A folder of its own that goes away.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "splatscope-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no scratch folder");
    path_ = name;
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

  // Names of everything in it, hidden files too, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_;
};

struct Outcome {
  int status = -1;  // of exit; -1: ended by a signal
  std::string out;
  std::string error;
};

// Runs splatscope, or a copy of it, with the given arguments in the given folder.
inline Outcome run_program(const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder = ".",
                           const std::string& program = SPLATSCOPE_PROGRAM) {
  const auto quoted = [](const std::string& word) {
    std::ostringstream
        text;  // for the shell: a quote within ends the word, stands escaped, and begins it again
    text << '\'';
    for (char c : word) c == '\'' ? text << "'\\''" : text << c;
    text << '\'';
    return text.str();
  };
  const ScratchFolder scratch;
  const auto out = scratch.path() / "out", error = scratch.path() / "error";
  std::string command = fmt::format("cd {} && {}", quoted(folder.string()), quoted(program));
  for (const std::string& argument : arguments) command += fmt::format(" {}", quoted(argument));
  command += fmt::format(" >{} 2>{}", quoted(out.string()), quoted(error.string()));
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(error)};
}

}  // namespace splatscope::tests
