#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "traces/models/mesh.h"

namespace splatscope::traces {

// A point of a mesh.
struct MeshSample {
  glm::vec3 position{};
  std::uint32_t triangle = 0;
  glm::dvec3 weights{};  // barycentric
};

// The point of `triangles`, at least one, that is closest to `place`; on ties that of the first.
MeshSample closest_sample(const TriangleCorners& mesh, std::span<const std::uint32_t> triangles,
                          const glm::dvec3& place);

}  // namespace splatscope::traces
