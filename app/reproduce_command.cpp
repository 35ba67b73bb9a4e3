#include <memory>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "studies/reproduction.h"

namespace splatscope::app {

void add_reproduce_command(CLI::App& app, Invocation& invocation) {
  struct Options {
    std::vector<std::string> names;
    std::string out = "out";
  };
  CLI::App* command = app.add_subcommand(
      "reproduce", "the published results on the simulated machines, beside the published figures");
  const auto options = std::make_shared<Options>();
  command->add_option("ID", options->names, "table1; all of them where none is given");
  command->add_option("--out", options->out, "folder for the results")->capture_default_str();
  command->footer("Example: splatscope reproduce table1 --out out");
  command->callback([options, &invocation] {
    ProgressBar progress("simulating", invocation.quiet);
    studies::reproduce(options->names, options->out, progress.callback());
  });
}

}  // namespace splatscope::app
