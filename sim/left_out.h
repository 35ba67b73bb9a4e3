#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/command/commands.h"
#include "sim/draw_jobs.h"

namespace splatscope::sim {

// A unit that the trace does not need, or work that some of its draws or triangles go past, and why.
struct UnitLeftOut {
  std::string name;  // "texture", "texture, pixel and blend in 4 of 8 draws"
  std::string why;   // "no draw samples a texture": a clause

  bool operator==(const UnitLeftOut&) const = default;
};

// First the units that `built` is without, then what of the others the draws did without. `jobs`: the draws
// of the trace, after they were given their work.
std::vector<UnitLeftOut> left_out(const Trace& trace, const Needs& built, std::span<const DrawJob> jobs);

}  // namespace splatscope::sim
