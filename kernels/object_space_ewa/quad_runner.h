#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "kernels/object_space_ewa/programs.h"
#include "kernels/reference/surfel_filter.h"
#include "kernels/splat_programs.h"
#include "model/isa/program.h"
#include "model/number/formats.h"
#include "model/vertex/vertex_program.h"

// Surfels through a vertex program, outside of a machine: for tests and figures.
namespace splatscope::kernels {

struct CornerOutput {
  glm::vec4 position;  // oPos
  glm::vec4 diffuse;   // oD0
  glm::vec2 texture;   // oT0.xy
  bool operator==(const CornerOutput&) const = default;
};
using QuadOutput = std::array<CornerOutput, 4>;  // in the order of kQuadCorners

// Whether its positions and diffuse colours are.
inline bool is_finite(const QuadOutput& quad) {
  for (const CornerOutput& corner : quad) {
    for (int i = 0; i < 4; ++i) {
      if (!std::isfinite(corner.position[i]) || !std::isfinite(corner.diffuse[i])) return false;
    }
  }
  return true;
}

inline constexpr double kCutoff = 1.0;  // c of Eq. 14

// Names the cases of a test over programs.
inline constexpr auto program_name = [](const auto& info) { return std::string(info.param.name); };

// Surfels whose vertices have `fields` through `program`. No format but binary32 rounds anything here.
inline std::vector<QuadOutput> run_quads(const isa::Program& program, std::span<const VertexField> fields,
                                         Arithmetic arithmetic, std::span<const Vec4> constants,
                                         std::span<const Surfel> surfels) {
  const vertex::VertexProgram executable(program, arithmetic);
  constexpr std::size_t kQuads = vertex::kBatch / 4;
  std::vector<QuadOutput> outputs(surfels.size());
  vertex::InputBatch in{};
  vertex::OutputBatch out{};
  for (std::size_t first = 0; first < surfels.size(); first += kQuads) {
    const std::size_t quads = std::min(kQuads, surfels.size() - first);
    for (std::size_t i = 0; i < 4 * quads; ++i) {
      const Corner corner{surfels[first + i / 4], kQuadCorners[i % 4], std::sqrt(2.0 * kCutoff)};
      for (const VertexField& field : fields) {
        const glm::dvec4 value = field.value(corner);
        for (int k = 0; k < 4; ++k) {
          const double component = k < components(field.format) ? value[k] : k == 3 ? 1.0 : 0.0;
          in.v[field.input][k][i] = static_cast<float>(component);
        }
      }
    }
    executable.run(constants, in, out, static_cast<int>(4 * quads));
    for (std::size_t i = 0; i < 4 * quads; ++i) {
      const auto read = [&](int reg, int component) { return out.o[reg][component][i]; };
      outputs[first + i / 4][i % 4] = {
          {read(vertex::oPos, 0), read(vertex::oPos, 1), read(vertex::oPos, 2), read(vertex::oPos, 3)},
          {read(vertex::oD0, 0), read(vertex::oD0, 1), read(vertex::oD0, 2), read(vertex::oD0, 3)},
          {read(vertex::oT0, 0), read(vertex::oT0, 1)}};
    }
  }
  return outputs;
}

inline std::vector<QuadOutput> run_quads(const SplatProgram& program, Arithmetic arithmetic,
                                         std::span<const Vec4> constants, std::span<const Surfel> surfels) {
  return run_quads(load_program(program.file), program.fields, arithmetic, constants, surfels);
}

inline std::vector<QuadOutput> run_quads(const SplatProgram& program, Arithmetic arithmetic, const View& view,
                                         double depth_offset, std::span<const Surfel> surfels) {
  return run_quads(program, arithmetic, program.constants(view, kCutoff, depth_offset), surfels);
}

// The corners in camera space. A program may scale oPos by any positive factor that is the same for the four
// vertices; their mean is the surfel's centre, which gives the factor.
inline std::array<glm::dvec3, 4> camera_space(const View& view, const Surfel& surfel,
                                              const QuadOutput& quad) {
  std::array<glm::dvec3, 4> corners;
  glm::dvec3 mean{0};
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec4 clip(quad[i].position);
    corners[i] = {clip.x * view.width / (2.0 * view.eta), clip.y * view.height / (2.0 * view.eta), clip.w};
    mean += 0.25 * corners[i];
  }
  const glm::dvec3 center = view.camera_space(surfel.position);
  for (glm::dvec3& corner : corners) corner *= glm::dot(center, center) / glm::dot(center, mean);
  return corners;
}

// The same in the surfel's plane, in units of s and t.
inline std::array<glm::dvec2, 4> tangent_plane(const View& view, const Surfel& surfel,
                                               const QuadOutput& quad) {
  const glm::dvec3 s = view.camera_direction(surfel.tangent_s);
  const glm::dvec3 t = view.camera_direction(surfel.tangent_t);
  const glm::dmat2 gram{{glm::dot(s, s), glm::dot(s, t)}, {glm::dot(s, t), glm::dot(t, t)}};
  std::array<glm::dvec2, 4> u;
  const auto corners = camera_space(view, surfel, quad);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 d = corners[i] - view.camera_space(surfel.position);
    u[i] = glm::inverse(gram) * glm::dvec2(glm::dot(d, s), glm::dot(d, t));
  }
  return u;
}

// y of Eq. 14 at the corners: where in the unit Gaussian their texture coordinates are.
inline std::array<glm::dvec2, 4> gaussian_coordinates(const QuadOutput& quad) {
  std::array<glm::dvec2, 4> y;
  for (std::size_t i = 0; i < 4; ++i)
    y[i] = 2.0 * std::sqrt(2.0 * kCutoff) * (glm::dvec2(quad[i].texture) - 0.5);
  return y;
}

// The view with every number rounded to binary32, as the constants hold it.
inline View rounded(View view) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      view.object_to_camera[column][row] = static_cast<float>(view.object_to_camera[column][row]);
    }
  }
  view.eta = static_cast<float>(view.eta);
  return view;
}

inline View test_view() {
  return rounded(look_at({0.3, -0.2, -4.0}, {0.1, 0.4, 1.0}, {0.1, 1.0, 0.05}, 60.0, 512, 512, 0.1, 1000.0));
}

// Its camera space is object space: exact numbers stay exact.
inline View plain_view() {
  View view = test_view();
  view.object_to_camera = glm::dmat4(1);
  return view;
}

// What a random surfel is drawn from; the logarithm of each range is uniform.
struct SurfelRanges {
  double depth[2] = {1.0, 100.0};    // camera z
  double cosine[2] = {1e-3, 1.0};    // of the angle between normal and viewing ray
  double spacing[2] = {0.05, 50.0};  // h in pixels where the plane faces the eye
  double sigma[2] = {0.3, 2.0};
};

// Inside the frame, with random azimuth of the normal and rotation of the tangents, in binary32 numbers.
template <typename Generator>
Surfel random_surfel(const View& view, const SurfelRanges& ranges, Generator& generator) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  const auto log_uniform = [&](const double(&range)[2]) {
    return std::exp(uniform(std::log(range[0]), std::log(range[1])));
  };
  const double depth = log_uniform(ranges.depth);
  const glm::dvec3 o = depth * glm::dvec3(uniform(-0.5, 0.5) * view.width / view.eta,
                                          uniform(-0.5, 0.5) * view.height / view.eta, 1.0);
  const glm::dvec3 ray = glm::normalize(o);
  const auto turned = [](const glm::dvec3& a, const glm::dvec3& b, double cosine) {
    return cosine * a + std::sqrt(1.0 - cosine * cosine) * b;
  };
  const auto perpendicular = [&](const glm::dvec3& axis) {  // a random direction at right angles
    const glm::dvec3 a =
        glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    return std::cos(angle) * a + std::sin(angle) * glm::cross(axis, a);
  };
  const glm::dvec3 normal = turned(-ray, perpendicular(ray), std::min(1.0, log_uniform(ranges.cosine)));
  const glm::dvec3 s = perpendicular(normal);
  const glm::dmat4 to_object = glm::inverse(view.object_to_camera);
  const double h = log_uniform(ranges.spacing) * depth / view.eta;
  Surfel surfel;
  surfel.position = glm::vec3(to_object * glm::dvec4(o, 1.0));
  surfel.tangent_s = glm::vec3(h * glm::dmat3(to_object) * s);
  surfel.tangent_t = glm::vec3(h * glm::dmat3(to_object) * glm::cross(normal, s));
  surfel.sigma = static_cast<float>(log_uniform(ranges.sigma));
  surfel.weight = static_cast<float>(uniform(0.2, 1.5));
  surfel.color = glm::vec3(uniform(0, 1), uniform(0, 1), uniform(0, 1));
  return surfel;
}

template <typename Generator>
std::vector<Surfel> random_surfels(const View& view, const SurfelRanges& ranges, std::size_t count,
                                   Generator& generator) {
  std::vector<Surfel> surfels(count);
  for (Surfel& surfel : surfels) surfel = random_surfel(view, ranges, generator);
  return surfels;
}

}  // namespace splatscope::kernels
