#include "traces/models/procedural.h"

#include <cmath>

#include "model/error.h"
#include "traces/models/parametric.h"
#include "traces/models/patterns.h"

namespace splatscope::traces {
namespace {

Paint painted(Pattern pattern, double scale) {
  return
      [=](const SurfacePoint& point) { return pattern_color(pattern, glm::dvec3(point.position) / scale); };
}

Model build(Generator generator) {
  switch (generator) {
    case Generator::plane:
      break;
    case Generator::sphere:
      return {
          sphere(128, [](const glm::dvec3& p) { return 1 + 0.06 * noise(4.0 * p) + 0.03 * noise(9.0 * p); }),
          painted(Pattern::zebra, 0.09)};
    case Generator::torus_knot:
      return {torus_knot(1024, 64), painted(Pattern::checker, 0.05)};
  }
  throw ModelError("make_procedural: no such model");
}

}  // namespace

Model make_procedural(Generator generator) {
  Model model = build(generator);
  mend(model.mesh);
  return model;
}

std::size_t default_count(Generator generator) {
  switch (generator) {
    case Generator::plane:
      break;
    case Generator::sphere:
    case Generator::torus_knot:
      return 100000;
  }
  throw ModelError("default_count: no such model");
}

}  // namespace splatscope::traces
