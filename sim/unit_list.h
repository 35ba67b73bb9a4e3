#pragma once

#include <vector>

#include "model/machine/machine.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// The statistics of every unit of a machine, whatever a trace needs of them, in the order of the units; all
// values are 0.
std::vector<UnitStatistic> declared_statistics(const Machine& machine);

}  // namespace splatscope::sim
