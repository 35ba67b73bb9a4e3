#include "app/machine_options.h"

#include <fmt/format.h>

#include <set>

#include "model/error.h"

namespace splatscope::app {

Machine machine_of(const std::string& name, const std::vector<std::string>& settings) {
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

std::vector<traces::NamedFile> named_files(const std::string& input, const std::string& machine,
                                           const std::vector<std::string>& programs) {
  std::vector<traces::NamedFile> files{{"INPUT", input}, {"--machine", machine}};
  for (const std::string& program : programs)
    files.push_back({"--program", program.substr(program.find('=') + 1)});
  return files;
}

}  // namespace splatscope::app
