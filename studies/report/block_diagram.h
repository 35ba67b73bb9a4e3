#pragma once

#include <string>
#include <string_view>

#include "sim/simulate.h"
#include "studies/report.h"

namespace splatscope::studies {

// The machine of a run as SVG that stands in a page of Report (whose style gives its colours): a box for each
// unit with a bar of the shares of its cycles, the pipeline from the host downwards, the memory beside it,
// and a line for each channel. A unit of a name that is not known here stands below the pipeline.
std::string block_diagram(const sim::Result& timing);

// The diagram, and the same shares as a table.
void add_machine(Report& report, std::string_view caption, const sim::Result& timing);

}  // namespace splatscope::studies
