#include "traces/models/procedural.h"

#include <algorithm>
#include <utility>

#include "model/error.h"
#include "traces/models/creatures.h"
#include "traces/models/parametric.h"

namespace splatscope::traces {
namespace {

Model build(Generator generator) {
  switch (generator) {
    case Generator::plane:
      break;
    case Generator::sphere:
      return {
          sphere(128, [](const glm::dvec3& p) { return 1 + 0.06 * noise(4.0 * p) + 0.03 * noise(9.0 * p); }),
          painted({{Pattern::zebra, {0.95f, 0.95f, 0.92f}, {0.07f, 0.06f, 0.06f}, 0.09}})};
    case Generator::torus_knot:
      return {torus_knot(1024, 64),
              painted({{Pattern::checker, {0.95f, 0.95f, 0.95f}, {0.10f, 0.15f, 0.35f}, 0.07}})};
    case Generator::salamander:
      return salamander();
    case Generator::chameleon:
      return chameleon();
    case Generator::wasp:
      return wasp();
    case Generator::fiesta:
      return fiesta();
  }
  throw ModelError("make_procedural: no such model");
}

}  // namespace

Paint painted(std::vector<Coat> coats) {
  return [coats = std::move(coats)](const SurfacePoint& point) {
    const Coat& coat = coats[std::min<std::size_t>(point.part, coats.size() - 1)];
    glm::dvec3 place = glm::dvec3(point.position) / coat.scale;
    std::swap(place.y, place[coat.up]);
    return pattern_color(coat.pattern, place, coat.light, coat.dark);
  };
}

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
    case Generator::salamander:
      return 103389;
    case Generator::chameleon:
      return 101685;
    case Generator::wasp:
      return 273325;
    case Generator::fiesta:
      return 352467;
  }
  throw ModelError("default_count: no such model");
}

}  // namespace splatscope::traces
