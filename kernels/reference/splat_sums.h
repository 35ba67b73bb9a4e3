#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace splatscope::kernels {

// What splats add up to, of every pixel at its centre, rows from the top.
struct SplatSums {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> sums;        // sum of s_k w_k rho_k(x), and in w of s_k rho_k(x)
  std::vector<glm::dvec3> normalized;  // sums divided by their w; 0 where nothing counts
};

// Colour of a pixel from its sums.
inline glm::dvec3 normalized_color(const glm::dvec4& sums) {
  return sums.w > 0 ? glm::dvec3(sums) / sums.w : glm::dvec3(0.0);
}

}  // namespace splatscope::kernels
