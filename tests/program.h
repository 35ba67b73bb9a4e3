#pragma once

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "model/testing/scratch_folder.h"

// Runs the program as a user does, for tests.
namespace splatscope::tests {

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
