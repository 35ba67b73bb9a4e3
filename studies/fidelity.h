#pragma once

#include <string>
#include <vector>

#include "studies/run.h"
#include "traces/scene.h"

namespace splatscope::studies {

// One fidelity on one scene and machine, against the referee on the same.
struct FidelityRow {
  std::string scene;
  std::string machine;
  Fidelity fidelity = Fidelity::functional;
  double host_seconds = 0;       // function and timing
  sim::Cycle cycles = 0;         // 0: functional
  double cycles_plus_minus = 0;  // of fidelity sampled
  double error = 0;              // of the cycles, relative
  struct UnitError {
    std::string unit;
    double error = 0;  // of its utilisation (busy cycles of all cycles)
  };
  std::vector<UnitError> units;
  double peak_megabytes = 0;  // resident memory of the process at most; 0: the system does not tell
};

// All five on one scene and both machines, the referee last of each machine. The host's seconds are the least
// of `repetitions` runs, but for the referee, which runs once.
std::vector<FidelityRow> fidelity_rows(const traces::Scene& scene, int repetitions,
                                       const Progress& progress = {});

// The study: the frames of Table 1, and the stand-ins of Table 2 with fewer surfels.
void study_fidelity(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
