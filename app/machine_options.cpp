#include "app/machine_options.h"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "model/error.h"

namespace splatscope::app {

void MachineOptions::add_to(CLI::App& command) {
  command.add_option("--machine", name, "name of a machine, or a TOML file")->capture_default_str();
  command
      .add_option(
          "--set", settings,
          "KEY=VALUE: a parameter of the machine, as `machine show` lists it; --set again for another")
      ->allow_extra_args(false);
  command
      .add_option("--program", programs,
                  "NAME=FILE: a program of one's own, text or tokens, in the place of the recorded one, as "
                  "in splat_ewa.vs=mine.vs")
      ->allow_extra_args(false);
}

Machine MachineOptions::machine() const {
  Machine machine = machine::load(name);
  std::set<std::string> given;
  for (const std::string& setting : settings) {
    machine::assign(machine, setting);
    const std::string key = setting.substr(0, setting.find('='));
    if (!given.insert(key).second)
      throw UserError("--set", 0, fmt::format("{} is given twice, expected one value", key));
  }
  return machine;
}

std::vector<traces::NamedFile> MachineOptions::files_with(const std::string& input) const {
  std::vector<traces::NamedFile> files{{"INPUT", input}, {"--machine", name}};
  for (const std::string& program : programs)
    files.push_back({"--program", program.substr(program.find('=') + 1)});
  return files;
}

void add_seed_option(CLI::App& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "of the random start of the samples of --fidelity sampled")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max() - 1))
      ->capture_default_str();
}

}  // namespace splatscope::app
