#pragma once

#include <vector>

#include "traces/models/implicit.h"
#include "traces/models/patterns.h"

// The stand-ins for the models of Ren 2002, Table 2, and what they are painted with. Unmended.
namespace splatscope::traces {

Model salamander();
Model chameleon();
Model wasp();
Model fiesta();

// A solid pattern in two colours.
struct Coat {
  Pattern pattern = Pattern::plain;
  glm::vec3 light{}, dark{};
  double scale = 1;  // size of the pattern, object units
  int up = 1;        // axis that the pattern takes for y: its stripes follow one another along it
};

// Each part of a mesh in its coat; parts beyond the last have the last one.
Paint painted(std::vector<Coat> coats);

// A point mirrored at the plane z = 0 for side = -1, as it is for 1.
inline glm::dvec3 on_side(const glm::dvec3& p, int side) {
  return {p.x, p.y, side * p.z};
}

}  // namespace splatscope::traces
