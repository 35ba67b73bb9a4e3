#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "app/commands.h"
#include "model/machine/machine.h"
#include "sim/unit_list.h"

namespace splatscope::app {
namespace {

// A line a parameter, and under it what it does and where its value comes from.
void show(const Machine& machine) {
  std::cout << fmt::format("{}: {}\n", machine.name, machine.title);
  for (const machine::ParameterValue& p : machine::describe(machine)) {
    std::cout << fmt::format("\n{} = {}{}{}    ({})\n  {}\n  {}", p.name, p.value, p.unit.empty() ? "" : " ",
                             p.unit, p.range, p.what, p.origin.confidence);
    if (!p.origin.fitted_to.empty()) std::cout << " to " << p.origin.fitted_to;
    if (!p.origin.source.empty()) std::cout << ": " << p.origin.source;
    std::cout << '\n';
  }
}

void show_as_markdown(const Machine& machine) {
  std::cout << "| parameter | value | unit | allowed | what it is | where it comes from "
               "|\n|---|---|---|---|---|---|\n";
  for (const machine::ParameterValue& p : machine::describe(machine)) {
    const std::string fitted = p.origin.fitted_to.empty() ? "" : " to " + p.origin.fitted_to;
    std::cout << fmt::format("| `{}` | {} | {} | {} | {} | {}{}{}{} |\n", p.name, p.value, p.unit, p.range,
                             p.what, p.origin.confidence, fitted, p.origin.source.empty() ? "" : ": ",
                             p.origin.source);
  }
}

// A line a statistic: unit, name, what is counted, what it is.
void list_units(const Machine& machine) {
  for (const sim::UnitStatistic& s : sim::declared_statistics(machine))
    std::cout << fmt::format("{:<13} {:<17} {:<10} {}\n", s.unit_name, s.name, s.unit, s.what);
}

}  // namespace

void add_machine_command(CLI::App& app) {
  CLI::App* machine = app.add_subcommand("machine", "the machines that can be simulated");
  machine->require_subcommand(1);
  machine->footer("Example: splatscope machine list");
  CLI::App* list = machine->add_subcommand("list", "their names");
  list->footer("Example: splatscope machine list");
  list->callback([] {
    for (std::string_view name : machine::built_in_names())
      std::cout << fmt::format("{:<18} {}\n", name, machine::load(name).title);
  });
  CLI::App* one = machine->add_subcommand("show", "every parameter with value, unit, range and source");
  const auto name = std::make_shared<std::string>();
  one->add_option("NAME", *name, "name of a machine, or a TOML file")->required();
  one->footer("Example: splatscope machine show geforce4-ti4400");
  const auto markdown = std::make_shared<bool>(false);
  one->add_flag("--markdown", *markdown, "as a table for the documentation");
  one->callback([name, markdown] { (*markdown ? show_as_markdown : show)(machine::load(*name)); });
  CLI::App* units = machine->add_subcommand("units", "the units of a machine, and what each of them counts");
  const auto of = std::make_shared<std::string>();
  units->add_option("NAME", *of, "name of a machine, or a TOML file")->required();
  units->footer("Example: splatscope machine units geforce4-ti4400");
  units->callback([of] { list_units(machine::load(*of)); });
}

}  // namespace splatscope::app
