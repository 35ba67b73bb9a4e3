#include "studies/report/configuration.h"

#include <fmt/format.h>

namespace splatscope::studies {

void add_configuration(Report& report, const Machine& machine) {
  std::vector<std::vector<std::string>> rows;
  for (const machine::ParameterValue& p : machine::describe(machine)) {
    const std::string source = p.origin.source.empty() ? "" : ": " + p.origin.source;
    const std::string fitted = p.origin.fitted_to.empty() ? "" : " (" + p.origin.fitted_to + ")";
    rows.push_back({p.name, p.value, p.unit, p.what, p.origin.confidence + fitted + source});
  }
  using enum Report::Align;
  report.folded_table(
      fmt::format("{} ({}): {} parameters and their sources", machine.name, machine.title, rows.size()),
      {{"parameter"}, {"value", number}, {"unit"}, {"what it is", prose}, {"where it comes from", prose}},
      rows);
}

}  // namespace splatscope::studies
