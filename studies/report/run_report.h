#pragma once

#include <nlohmann/json.hpp>

#include "studies/report.h"
#include "studies/run.h"

namespace splatscope::studies {

// What `run` did as a page: the picture (against the reference where there is one), the times, the roofline,
// the machine, the counts, and every parameter with its source. `results`: of results_of.
Report run_report(const Input& input, const Machine& machine, const FrameRun& run,
                  const nlohmann::ordered_json& results);

}  // namespace splatscope::studies
