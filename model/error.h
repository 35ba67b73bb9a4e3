#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace splatscope {

// What a user gave is wrong: a program, a scene, a machine, a trace, an output folder. `app` prints what()
// and exits with 2. The text is one line: "file:line: what is wrong, what was expected" (line 0: no line,
// "file: ...").
class UserError : public std::runtime_error {
 public:
  UserError(std::string_view file, int line, std::string_view message)
      : std::runtime_error(line > 0 ? fmt::format("{}:{}: {}", file, line, message)
                                    : fmt::format("{}: {}", file, message)) {}
  // "file:line:column: ...", for programs.
  UserError(std::string_view file, int line, int column, std::string_view message)
      : std::runtime_error(fmt::format("{}:{}:{}: {}", file, line, column, message)) {}
};

// A bug in splatscope itself: a broken invariant, a deadlock of the simulated machine.
class ModelError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace splatscope
