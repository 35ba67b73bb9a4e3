#include "kernels/voxel_ewa/programs.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <numbers>

#include "kernels/vec4.h"

namespace splatscope::kernels {
std::vector<Vec4> voxel_constants(const View& view, const glm::dmat4& to_object, const glm::dmat3* variance,
                                  double cutoff, double unit) {
  const double eta = view.eta, near = view.near_plane;
  const double depth = view.depth_scale();
  const glm::dmat4 rows = glm::transpose(view.object_to_camera * to_object);
  const auto row = [&](int i, double scale) {
    return vec4(scale * rows[i].x, scale * rows[i].y, scale * rows[i].z, scale * rows[i].w);
  };
  std::vector<Vec4> c{row(0, eta), row(1, eta), row(2, 1), {}, {}, {}};
  double z_squared_factor = 1;  // of the matrix that the program factors, over z^2 (V' + I)
  if (variance != nullptr) {
    const glm::dmat3 w(view.object_to_camera);
    const glm::dmat3 m = cutoff * (w * *variance * glm::transpose(w));
    c[3] = vec4(-2 * eta * m[2][0], 0, eta * eta * m[0][0], cutoff);
    c[4] = vec4(0, -2 * eta * m[2][1], eta * eta * m[1][1], cutoff);
    c[5] = vec4(-eta * m[2][1], -eta * m[2][0], eta * eta * m[1][0], 0);
    c.push_back(vec4(m[2][2], 0, 0, 0));
    z_squared_factor = cutoff;
  } else {
    c.push_back(vec4(0, std::sqrt(cutoff), 0, 0));
  }
  c.push_back(vec4(2.0 / view.width, 2.0 / view.height, 0, 1));
  c.push_back(vec4(depth, -near * depth, 0.5, 0));
  // peak = eta^2 |t|/z^3 |W| / (2 pi sqrt |V' + I|), and the roots of the two determinants differ by
  // z_squared_factor z^2.
  const double height = unit * eta * eta * z_squared_factor * 0.5 * std::numbers::inv_pi *
                        std::abs(glm::determinant(glm::dmat3(view.object_to_camera)));
  const double squared = height * height;
  c.push_back(vec4(squared / (eta * eta), squared / (eta * eta), 0, squared));
  return c;
}

ShaderText voxel_pixel_program(int steps) {
  return {fmt::format("voxel_{}.ps", steps),
          fmt::format(
              "ps_1_1\n"
              "; opacity = texel * diffuse alpha, colour times that; both times c0 = {}/255 at the end, as\n"
              "; results have steps of 1/255\n"
              "def c0, {:.9g}, {:.9g}, {:.9g}, {:.9g}\n"
              "tex t0\n"
              "mul r0.a, t0, v0\n"
              "mul r0.rgb, v0, r0.a\n"
              "mul r0, r0, c0\n",
              steps, steps / 255.0, steps / 255.0, steps / 255.0, steps / 255.0)};
}

}  // namespace splatscope::kernels
