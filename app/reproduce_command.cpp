#include <memory>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "studies/reproduction/reproduction.h"

namespace splatscope::app {

void add_reproduce_command(CLI::App& app, Invocation& invocation) {
  struct Options {
    std::vector<std::string> names;
    std::string out = "out";
  };
  CLI::App* command = app.add_subcommand(
      "reproduce", "the published results on the simulated machines, beside the published figures");
  const auto options = std::make_shared<Options>();
  command->add_option("ID", options->names,
                      studies::names_of(studies::reproductions()) + "; all of them where none is given");
  command->add_option("--out", options->out, "folder for the results")->capture_default_str();
  command->footer("Example: splatscope reproduce table1 --out out");
  command->callback([options, &invocation] {
    const auto chosen = studies::choose(studies::reproductions(), "reproduce", options->names);
    studies::Findings findings(
        options->out, "splatscope: published results made again",
        "Ren, Pfister and Zwicker, Object Space EWA Surface Splatting (2002), on the simulated machines; and "
        "Zwicker, Pfister, van Baar and Gross, EWA Splatting (2002, here: Zwicker 2002), in software and on "
        "these machines.");
    ProgressBar progress("simulating", invocation.quiet);
    studies::run_studies(chosen, findings, progress.callback());
  });
}

}  // namespace splatscope::app
