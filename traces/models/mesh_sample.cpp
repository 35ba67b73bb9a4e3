#include "traces/models/mesh_sample.h"

#include <glm/geometric.hpp>
#include <limits>

#include "traces/models/voxels.h"

namespace splatscope::traces {

MeshSample closest_sample(const TriangleCorners& mesh, std::span<const std::uint32_t> triangles,
                          const glm::dvec3& place) {
  MeshSample best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t number : triangles) {
    const Triangle t = triangle_of(mesh, number);
    const glm::dvec3 weights = closest_point(t, place);
    const glm::dvec3 point = point_at(t, weights);
    const glm::dvec3 to = point - place;
    const double distance = glm::dot(to, to);
    if (!(distance < least)) continue;
    least = distance;
    best = {glm::vec3(point), number, weights};
  }
  return best;
}

}  // namespace splatscope::traces
