#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "traces/scene.h"

namespace splatscope::traces {

// What surfels lack, from their nearest neighbours. Positions must be finite.

// Radius: the largest distance to the `neighbours` nearest surfels (0 where all of them lie on the same
// point).
void estimate_radii(std::span<Surfel> surfels, int neighbours);

// Normal: the direction in which the `neighbours` nearest surfels and the surfel itself spread least
// (principal component analysis), turned toward the eye; (0, 0, 0) where they all lie on one line or point.
void estimate_normals(std::span<Surfel> surfels, int neighbours, const glm::dvec3& eye);

// Mean distance to the nearest surfel elsewhere, object units; 0 where there is none.
double average_spacing(std::span<const Surfel> surfels);

}  // namespace splatscope::traces
