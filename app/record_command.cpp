#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <vector>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "model/error.h"
#include "model/machine/machine.h"
#include "studies/run.h"
#include "studies/run_files.h"
#include "traces/output_files.h"
#include "traces/trace_file.h"

namespace splatscope::app {
namespace {

struct Options {
  std::string scene;
  std::string machine{machine::kGeForce4};
  std::string out;
};

void record(const Options& options, bool quiet) {
  const std::vector<traces::NamedFile> written{{"-o", options.out}};
  traces::expect_apart(written, {{"SCENE", options.scene}, {"--machine", options.machine}});
  const Machine machine = machine::load(options.machine);
  ProgressBar loading("loading", quiet);
  auto opened = studies::open_input(options.scene, loading.callback());
  loading.clear();
  if (std::holds_alternative<Trace>(opened))
    throw UserError(options.scene, 0, "is a trace already, expected a scene");
  traces::expect_apart(written, studies::files_of(opened));
  { const traces::OutputFile writable(options.out); }  // before the work, not after it
  ProgressBar recording("recording", quiet);
  const studies::Input input =
      studies::make_input(std::move(opened), options.scene, machine, recording.callback());
  recording.clear();
  traces::write_trace(input.trace, options.out);
  std::cout << (input.volume ? fmt::format("{}: {}\n", options.out, traces::describe(*input.volume))
                             : fmt::format("{}: {} surfels, {}\n", options.out, input.recorded->scene_surfels,
                                           traces::describe(input.skipped, input.estimated)));
}

}  // namespace

void add_record_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("record", "a scene as a self-contained trace");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "scene file (TOML), or the name of a ready scene")->required();
  command->add_option("-o", options->out, "trace file to write")->required();
  command->add_option("--machine", options->machine, "machine whose arithmetic captures the weights")
      ->capture_default_str();
  command->footer("Example: splatscope record checkerboard-ewa-per-surfel -o plane.trace");
  command->callback([options, &invocation] { record(*options, invocation.quiet); });
}

}  // namespace splatscope::app
