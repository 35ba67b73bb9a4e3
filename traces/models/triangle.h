#pragma once

#include <array>
#include <glm/vec3.hpp>

// A triangle against a box and against a point.
namespace splatscope::traces {

using Triangle = std::array<glm::dvec3, 3>;

// Whether a triangle and an axis-aligned box share a point, touching included (Akenine-Moeller 2001: two
// convex bodies are apart exactly where a plane lies between them, and that plane is perpendicular to an axis
// of the box, to the triangle's normal, or to an edge of each). Rounding may call a box that is missed by
// about 1e-12 of its size touched.
bool overlaps(const Triangle& triangle, const glm::dvec3& center, const glm::dvec3& half_size);

// Barycentric weights of the point of the triangle that is closest to `point`: each >= 0, their sum 1.
glm::dvec3 closest_point(const Triangle& triangle, const glm::dvec3& point);

inline glm::dvec3 point_at(const Triangle& triangle, const glm::dvec3& weights) {
  return weights.x * triangle[0] + weights.y * triangle[1] + weights.z * triangle[2];
}

}  // namespace splatscope::traces
