#include <fmt/format.h>

#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "app/commands.h"
#include "app/machine_options.h"
#include "app/progress_bar.h"
#include "studies/result_files.h"
#include "studies/run_files.h"
#include "studies/sweep.h"
#include "studies/sweep_report.h"
#include "traces/output_files.h"

namespace splatscope::app {
namespace {

struct Options {
  std::string input;
  MachineOptions machine;
  std::string fidelity = "cycle";
  std::vector<std::string> swept;
  std::uint64_t seed = 1;
  std::optional<std::string> cache;
  std::string out = "out";
};

void print(const studies::Sweep& sweep) {
  for (const std::string& line : sweep.replaced) std::cout << line << '\n';
  for (const studies::SweepPoint& point : sweep.points) {
    std::string settings;
    for (const auto& [key, value] : point.settings) settings += fmt::format("{}={}  ", key, value);
    std::cout << fmt::format(
        "{}{}  {:.2f} fps\n", settings,
        studies::text_of_cycles(point.results["frames"].size(), point.cycles, point.cycles_plus_minus),
        point.rate.fps);
  }
  for (const auto& path : sweep.damaged)
    std::cout << path.string() << ": damaged or of another format; computed again\n";
  for (const std::string& why : sweep.not_kept)
    std::cout << why << "; the work is not kept for later sweeps\n";
}

void run(const Options& options, bool quiet) {
  studies::expect_apart_from_results(options.machine.files_with(options.input), options.out);
  const Machine machine = options.machine.machine();
  const studies::Fidelity fidelity = studies::fidelity_by_name(options.fidelity);
  const auto swept = studies::swept_parameters(options.swept, options.machine.settings);
  std::optional<traces::OutputFolder> folder;
  ProgressBar running("running", quiet);
  const auto before_work = [&](const studies::Opened& opened) {
    studies::expect_apart_from_results(studies::files_of(opened), options.out);
    folder.emplace(options.out);
  };
  const studies::Sweep sweep = studies::run_sweep(options.input, machine, swept, fidelity,
                                                  {.programs = options.machine.programs,
                                                   .cache = options.cache,
                                                   .seed = options.seed,
                                                   .before_work = before_work},
                                                  running.callback());
  running.clear();
  studies::ResultFiles files(folder->path());
  traces::write_file(files.place("sweep.csv"), studies::csv_of(sweep));
  studies::report_of(sweep, machine, fidelity).write(files.place("report.html"));
  files.commit(studies::results_of(sweep, machine, fidelity));
  print(sweep);
  std::cout << fmt::format("{:.1f} s; results.json, sweep.csv and report.html in {}\n", sweep.host_seconds,
                           options.out);
}

}  // namespace

void add_sweep_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("sweep", "one frame on many machines: its function once, its time on each");
  const auto options = std::make_shared<Options>();
  command->add_option("INPUT", options->input, "scene file (TOML), name of a ready scene, or FILE.trace")
      ->required();
  command
      ->add_option("--sweep", options->swept,
                   "KEY=VALUE,VALUE,...: a parameter of the machine; several give every combination")
      ->required()
      ->allow_extra_args(false);
  options->machine.add_to(*command);
  command->add_option("--fidelity", options->fidelity, "throughput, sampled, cycle or referee")
      ->capture_default_str();
  add_seed_option(*command, options->seed);
  command->add_option("--cache", options->cache,
                      "folder that keeps what the function of a frame gives the timing, for later sweeps");
  command->add_option("--out", options->out, "folder for the results")->capture_default_str();
  command->footer(
      "Example: splatscope sweep checkerboard-ewa-per-surfel --sweep vertex.units=1,2,3,4 --sweep "
      "memory.channels=1,2,4 --out out/sweep");
  command->callback([options, &invocation] { run(*options, invocation.quiet); });
}

}  // namespace splatscope::app
