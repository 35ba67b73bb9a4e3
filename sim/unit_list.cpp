#include "sim/unit_list.h"

namespace splatscope::sim {

std::vector<UnitStatistic> declared_statistics(const Machine& machine) {
  Trace empty;
  empty.width = empty.height = 1;
  const MemoryLayout layout = lay_out(empty, machine);
  const auto built = build_machine(empty, prepare_draws(empty, machine, layout), layout, machine,
                                   Scheduler::skip_ahead, UnitChoice::all);
  std::vector<UnitStatistic> list;
  for (const auto& unit : built->units) {
    for (const Statistic& statistic : unit->statistics(kNever)) {
      list.push_back({unit->name(), std::string(statistic.name), std::string(statistic.unit),
                      std::string(statistic.what), statistic.value});
    }
  }
  return list;
}

}  // namespace splatscope::sim
