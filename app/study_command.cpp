#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "studies/studies.h"

namespace splatscope::app {

void add_study_command(CLI::App& app, Invocation& invocation) {
  struct Options {
    std::vector<std::string> names;
    std::string out = "out";
    bool list = false;
  };
  CLI::App* command =
      app.add_subcommand("study", "questions to the simulated machines beyond what is published");
  const auto options = std::make_shared<Options>();
  CLI::Option* names = command->add_option("NAME", options->names, studies::names_of(studies::own_studies()));
  command->add_option("--out", options->out, "folder for the results")->capture_default_str();
  command->add_flag("--list", options->list, "only list the studies, a line each")->excludes(names);
  command->footer("Example: splatscope study vertex-data --out out");
  command->callback([options, &invocation] {
    if (options->list) {
      for (const studies::Study& study : studies::own_studies())
        std::cout << fmt::format("{:<14} {}\n", study.name, study.what);
      return;
    }
    if (options->names.empty()) throw CLI::RequiredError("NAME");
    const auto chosen = studies::choose(studies::own_studies(), "study", options->names);
    studies::Findings findings(options->out, "splatscope: studies",
                               "What the simulated machines of 2002 say beyond the published results.");
    ProgressBar progress("simulating", invocation.quiet);
    studies::run_studies(chosen, findings, progress.callback());
  });
}

}  // namespace splatscope::app
