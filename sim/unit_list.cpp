#include "sim/unit_list.h"

#include <iterator>

namespace splatscope::sim {

std::vector<UnitStatistic> declared_statistics(const Machine& machine) {
  Trace empty;
  empty.width = empty.height = 1;
  const MemoryLayout layout = lay_out(empty, machine);
  const auto built = build_machine(empty, prepare_draws(empty, machine, layout), layout, machine,
                                   Scheduler::skip_ahead, UnitChoice::all);
  std::vector<UnitStatistic> list;
  for (const auto& unit : built->units) std::ranges::move(named_statistics(*unit), std::back_inserter(list));
  return list;
}

}  // namespace splatscope::sim
