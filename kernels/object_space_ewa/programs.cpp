#include "kernels/object_space_ewa/programs.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>

#include "kernels/vec4.h"
#include "model/embedded_file.h"
#include "model/error.h"

namespace splatscope {
std::span<const EmbeddedFile> embedded_programs();  // written by the build: ../build.cmake
}

namespace splatscope::kernels {
namespace {

// Relative and absolute floor of D^2 in splat_ewa.vs. Together they keep the entries of J^-1 J^-T under
// 1/(2 * 1e-11 * sqrt(1e-16)) = 5e18, whose square is still a float; at cos = 1e-3 they add 1e-5 of D^2.
constexpr double kRelativeFloor = 1e-11;
constexpr double kAbsoluteFloor = 1e-16;
// In place of |p| = 0: far under p of any surfel up to 1e6 pixels wide, and its square is no denormal.
constexpr double kSmallestP = 1e-15;

// 1/side, up where it rounds: half a side then becomes 1/2 in either arithmetic, and texture coordinates 0
// and 1.
float inverse_side(float side) {
  const float inverse = 1.0f / side;
  return static_cast<double>(side) * inverse < 1.0 ? std::nextafter(inverse, 1.0f) : inverse;
}

}  // namespace

ShaderText shader_text(std::string_view name) {
  for (const EmbeddedFile& file : embedded_programs()) {
    if (file.name == name) return {std::string(file.name), std::string(file.text)};
  }
  throw ModelError(fmt::format("no program {} in kernels", name));
}

std::vector<Vec4> splat_constants(const View& view, double cutoff, double depth_offset) {
  std::vector<Vec4> c(kSplatConstantCount);
  const glm::dmat4& m = view.object_to_camera;
  for (int row = 0; row < 3; ++row) {
    c[static_cast<std::size_t>(row)] = vec4(m[0][row], m[1][row], m[2][row], m[3][row]);
  }
  const double near = view.near_plane;
  const double depth = view.depth_scale();  // clip z from 0 at the near plane to w at the far plane
  const double radius = std::sqrt(2.0 * cutoff);
  c[3] = vec4(2.0 * view.eta / view.width, 2.0 * view.eta / view.height, near, 1.0);
  c[4] = vec4(depth, -near * depth, depth_offset, 0.5);
  c[5] = vec4(2.0 * radius, -radius, 2.0, -1.0);
  c[6] = vec4(view.eta, -view.eta, 0.0, 0.5 * std::numbers::inv_pi);
  // Half the depth over sqrt(2) sqrt(2c), the longest y.
  c[7] = vec4(kAbsoluteFloor, kRelativeFloor, 0.25 / std::sqrt(cutoff), kSmallestP);
  const float side = static_cast<float>(2.0 * std::sqrt(cutoff));
  c[8] = {side, -0.5f * side, inverse_side(side), 0.5f};
  c[9] = {0, 0, 0, std::numeric_limits<float>::min()};
  return c;
}

}  // namespace splatscope::kernels
