#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "model/machine/machine.h"
#include "traces/output_files.h"
#include "traces/recorder.h"
#include "traces/trace_file.h"

namespace splatscope::app {
namespace {

struct Options {
  std::string scene;
  std::string machine = "geforce4-ti4400";
  std::string out;
};

void record(const Options& options, bool quiet) {
  const NumberFormats numbers = machine::load(options.machine).numbers;
  ProgressBar loading("loading", quiet);
  const traces::Scene scene = traces::load_scene(options.scene, loading.callback());
  loading.clear();
  { const traces::OutputFile writable(options.out); }  // before the work, not after it
  traces::Recording recording;
  {
    ProgressBar progress("recording", quiet);
    recording = traces::record(scene, numbers, progress.callback());
  }
  traces::write_trace(recording.trace, options.out);
  std::cout << fmt::format("{}: {} surfels, {}\n", options.out, recording.counts.surfels,
                           traces::describe(scene.skipped));
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
