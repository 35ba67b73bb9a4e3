#pragma once

#include <functional>

#include "traces/models/mesh.h"

// Meshes of surfaces in closed form.
namespace splatscope::traces {

// A tube of elliptic section around a (2, 3) torus knot, closed; `steps` along the knot, `sides` around it.
Mesh torus_knot(int steps, int sides);

// The unit sphere, each point moved outward to `radius` of it; 6 * cells * cells quads of about equal size.
Mesh sphere(int cells, const std::function<double(const glm::dvec3&)>& radius);

}  // namespace splatscope::traces
