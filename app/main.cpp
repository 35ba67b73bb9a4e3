#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "app/commands.h"
#include "model/error.h"

namespace {

enum Exit : int { kDone = 0, kFailed = 1, kBadInput = 2 };

int run(int argc, char** argv) {
  using namespace splatscope::app;
  CLI::App app("splatscope: a cycle-level simulator of a programmable GPU of 2002, and EWA splatting on it");
  app.require_subcommand(1);
  app.fallthrough();  // --quiet may stand after the command
  Invocation invocation;
  app.add_flag("--quiet", invocation.quiet, "no progress bar");
  add_reproduce_command(app, invocation);
  add_run_command(app, invocation);
  add_study_command(app, invocation);
  add_sweep_command(app, invocation);
  add_record_command(app, invocation);
  add_sample_command(app, invocation);
  add_machine_command(app);
  add_shader_command(app);
  add_trace_command(app);
  add_explain_command(app, invocation);
  add_scene_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::cerr << "splatscope: " << error.what() << " (--help says what is expected)\n";
    return kBadInput;
  }
  return invocation.status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const splatscope::UserError& error) {
    std::cerr << error.what() << '\n';
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "splatscope: " << error.what() << '\n';
    return kFailed;
  }
}
