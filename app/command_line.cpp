#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>

#include "app/commands.h"
#include "model/control_characters.h"
#include "model/error.h"
#include "model/stop.h"

namespace splatscope::app {
namespace {

enum Exit : int { kFailed = 1, kBadInput = 2, kInterrupted = 128 };  // plus the signal

extern "C" void ask_to_stop(int signal) {
  stop_signal.store(signal, std::memory_order_relaxed);
}

// Ctrl-C, and what asks a process to end. A second one ends it at once. Where a signal was ignored from the
// start (nohup), it stays so. SIGXFSZ is ignored: to write beyond a limit of file sizes is then an error like
// a full disk, not the end.
void listen_to_signals() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // no SA_RESTART: what waits for input must stop, too
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

// What was printed has arrived, also where standard output is a file on a full disk.
void flush_output() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0)  // of a line before, too
    throw std::runtime_error("standard output: writing failed (is the disk full?)");
}

// Of a message of a library, too: one line, of a length that can be read.
std::string one_line(std::string text) {
  constexpr std::size_t kMost = 1000, kStart = 200, kEnd = 700;  // bytes
  if (text.size() > kMost) text = text.substr(0, kStart) + " ... " + text.substr(text.size() - kEnd);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t i = 0; i < text.size(); ++i)
    std::fill_n(&text[i], leading_control_character(std::string_view(text).substr(i)), ' ');
  return text;
}

// An empty word means nothing to any option; it comes from a variable of a script that is not set. CLI11
// checks no empty word for an option whose value can be left out: --reference looks at its own.
void refuse_empty_values(CLI::App& command) {
  const auto check = [](const std::string& value) {
    return value.empty() ? std::string("\"\" is empty, expected a name or a value") : std::string();
  };
  for (CLI::Option* option : command.get_options()) option->check(check);
  for (CLI::App* part : command.get_subcommands([](CLI::App*) { return true; })) refuse_empty_values(*part);
}

// Words that nothing takes, in their order: CLI11's own message turns it round.
std::string not_expected(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  const bool apart = std::ranges::any_of(left, [](const std::string& word) { return word.starts_with('='); });
  return one_line(
      fmt::format("splatscope: not expected: {} ({})", fmt::join(left, " "),
                  apart ? "a key and its value are one word: KEY=VALUE" : "--help says what is expected"));
}

// Where a word stands in the place of a command: that, and which there are. Empty: it is something else.
std::string unknown_command(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  std::vector<std::string> names;
  for (const CLI::App* part : command->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(part->get_name());
  if (left.empty() || left.front().starts_with('-') || names.empty()) return {};
  return one_line(
      fmt::format("splatscope: no command \"{}\", expected {}", left.front(), fmt::join(names, ", ")));
}

int run(int argc, const char* const* argv) {
  CLI::App app("splatscope: a cycle-level simulator of a programmable GPU of 2002, and EWA splatting on it");
  app.require_subcommand(1);
  app.footer("Example: splatscope run checkerboard-ewa-per-surfel --out out");
  app.fallthrough();  // --quiet may stand after the command
  Invocation invocation;
  app.add_flag("--quiet", invocation.quiet, "no progress bar");
  add_reproduce_command(app, invocation);
  add_run_command(app, invocation);
  add_study_command(app, invocation);
  add_sweep_command(app, invocation);
  add_volume_command(app, invocation);
  add_record_command(app, invocation);
  add_sample_command(app, invocation);
  add_machine_command(app);
  add_shader_command(app);
  add_trace_command(app);
  add_explain_command(app, invocation);
  add_scene_command(app);
  refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    if (const std::string unknown = unknown_command(app); !unknown.empty()) {
      std::cerr << unknown << '\n';
      return kBadInput;
    }
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
      std::cerr << not_expected(app) << '\n';
      return kBadInput;
    }
    std::cerr << "splatscope: " << one_line(error.what()) << " (--help says what is expected)\n";
    return kBadInput;
  }
  return 0;
}

// The line on standard error for what ended the program, and its exit status.
int report(const std::exception& error, int status) {
  const int signal = stop_signal.load();
  if (signal != 0) status = kInterrupted + signal;  // whatever the signal made fail
  const std::string text = signal != 0           ? "splatscope: interrupted"
                           : status == kBadInput ? error.what()
                                                 : fmt::format("splatscope: {}", error.what());
  std::cerr << one_line(text) << '\n';
  return status;
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  listen_to_signals();
  try {
    const int status = run(argc, argv);
    flush_output();
    return status;
  } catch (const UserError& error) {
    return report(error, kBadInput);
  } catch (const std::exception& error) {
    return report(error, kFailed);
  }
}

}  // namespace splatscope::app
