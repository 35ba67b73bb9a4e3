#pragma once

#include <glm/vec4.hpp>

#include "model/command/commands.h"

namespace splatscope::kernels {

// A program's constant.
inline Vec4 vec4(const glm::dvec4& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(v.w)};
}
inline Vec4 vec4(double x, double y, double z, double w) {
  return vec4(glm::dvec4(x, y, z, w));
}

}  // namespace splatscope::kernels
