#pragma once

#include "model/machine/machine.h"
#include "studies/report.h"

namespace splatscope::studies {

// Every parameter of a machine with its value, and where that comes from; folded away.
void add_configuration(Report& report, const Machine& machine);

}  // namespace splatscope::studies
