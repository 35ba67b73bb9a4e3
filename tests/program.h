#pragma once

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/shell_word.h"
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
  const ScratchFolder scratch;
  const auto out = scratch.path() / "out", error = scratch.path() / "error";
  std::string command = fmt::format("cd {} && {}", shell_word(folder.string()), shell_word(program));
  for (const std::string& argument : arguments) command += fmt::format(" {}", shell_word(argument));
  command += fmt::format(" >{} 2>{}", shell_word(out.string()), shell_word(error.string()));
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(error)};
}

// What a command wrote into its folder.
inline nlohmann::json results_in(const std::filesystem::path& folder) {
  return nlohmann::json::parse(text_of(folder / "results.json"));
}

}  // namespace splatscope::tests
