#include <iostream>
#include <memory>

#include "app/commands.h"
#include "traces/trace_info.h"

namespace splatscope::app {

void add_trace_command(CLI::App& app) {
  CLI::App* trace = app.add_subcommand("trace", "look at traces");
  trace->require_subcommand(1);
  trace->footer("Example: splatscope trace info plane.trace");
  CLI::App* info = trace->add_subcommand("info", "what a trace holds");
  const auto file = std::make_shared<std::string>();
  info->add_option("FILE", *file, "trace file")->required();
  info->footer("Example: splatscope trace info plane.trace");
  info->callback([file] { std::cout << traces::describe(traces::read_trace(*file)); });
}

}  // namespace splatscope::app
