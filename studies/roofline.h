#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/machine/machine.h"
#include "sim/simulate.h"
#include "studies/plot.h"

// What a run asked of the machine against what the machine can give.
namespace splatscope::studies {

struct Ceiling {
  std::string name;   // "memory"
  std::string unit;   // "bytes"
  std::string what;   // one line
  double demand = 0;  // of the run
  double peak = 0;    // a second
  double share = 0;   // of the peak that was used while the run went on, 0 to 1
  double fps = 0;     // frames a second that it alone would allow; infinite where nothing is asked
};

// Instructions of the vertex units, fill (quads out of the rasteriser), memory, bus. Empty where no events
// were simulated: the statistics of the units are what counts.
std::vector<Ceiling> ceilings(const Machine& machine, const sim::Result& timing);

// Instructions a second against instructions a byte or a quad (log-log): a flat roof for the instructions, a
// slope for each of the others that the run used, and where the run stood under each. Nothing where there is
// no instruction or nothing else.
std::optional<Plot> roofline_plot(const std::vector<Ceiling>& ceilings, double seconds);

nlohmann::ordered_json json_of(const std::vector<Ceiling>& ceilings);

}  // namespace splatscope::studies
