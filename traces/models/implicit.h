#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "traces/models/mesh.h"

// Bodies out of bones with flesh on them, and their surface as a mesh.
namespace splatscope::traces {

// A segment with a radius at each end. `flat` pulls it into a blade: along that direction it is thinner by
// `thinness`. Bones of the same limb stand one after the other in a body and join as they are; a limb melts
// into those before it over the distance `blend`.
struct Bone {
  glm::dvec3 a{}, b{};
  double radius_a = 0, radius_b = 0;  // > 0
  std::uint32_t part = 0;             // of the mesh
  double blend = 0;                   // the same for a whole limb
  glm::dvec3 flat{};                  // of unit length; (0, 0, 0): round
  double thinness = 1;                // >= 1
  std::size_t limb = 0;
};

using Body = std::vector<Bone>;

// How a limb is made of flesh.
struct Flesh {
  std::uint32_t part = 0;
  double blend = 0;
  glm::dvec3 flat{};
  double thinness = 1;
};

// A point of a spine: where, and how thick the body is there.
struct Vertebra {
  glm::dvec3 position{};
  double radius = 0;
};

// Bones along the curve through `spine` (Catmull-Rom), `steps` between two of its points.
void add_limb(Body& body, std::span<const Vertebra> spine, const Flesh& flesh, int steps = 6);

inline void add_ball(Body& body, const glm::dvec3& center, double radius, const Flesh& flesh) {
  body.push_back(
      {center, center, radius, radius, flesh.part, flesh.blend, flesh.flat, flesh.thinness, body.size()});
}

// Distance to the body's surface, negative inside: exact for a ball, about right near other bones, and too
// small rather than too large away from them.
double distance(std::span<const Bone> body, const glm::dvec3& point);

// The surface as a closed mesh of triangles about `cell` across, with normals, by naive surface nets on the
// cells of a grid that the surface passes through (Gibson 1998). Details thinner than a cell are lost. The
// same result for any number of threads.
Mesh surface_of(const Body& body, double cell);

}  // namespace splatscope::traces
