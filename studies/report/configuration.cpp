#include "studies/report/configuration.h"

#include <fmt/format.h>

namespace splatscope::studies {

void add_configuration(Report& report, const Machine& machine) {
  std::vector<std::vector<std::string>> rows;
  for (const machine::ParameterValue& p : machine::describe(machine)) {
    std::string origin = p.origin.confidence;
    if (!p.origin.fitted_to.empty()) origin += " (" + p.origin.fitted_to + ")";
    if (!p.origin.source.empty()) origin += ": " + p.origin.source;
    rows.push_back({p.name, p.value, p.unit, p.what, origin});
  }
  using enum Report::Align;
  report.folded_table(
      fmt::format("{} ({}): {} parameters and their sources", machine.name, machine.title, rows.size()),
      {{"parameter"}, {"value", number}, {"unit"}, {"what it is", prose}, {"where it comes from", prose}},
      rows);
}

}  // namespace splatscope::studies
