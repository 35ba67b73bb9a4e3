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
#include <vector>

#include "kernels/object_space_ewa/programs.h"
#include "kernels/reference/surfel_filter.h"
#include "model/isa/program.h"
#include "model/number/formats.h"
#include "model/vertex/vertex_program.h"

// For the tests of this folder: surfels through a vertex program.
namespace splatscope::kernels {

inline constexpr glm::vec2 kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

struct CornerOutput {
  glm::vec4 position;  // oPos
  glm::vec4 diffuse;   // oD0
  glm::vec2 texture;   // oT0.xy
  bool operator==(const CornerOutput&) const = default;
};
using QuadOutput = std::array<CornerOutput, 4>;  // in the order of kCorners

inline isa::Program load_program(std::string_view name) {
  const ShaderText text = object_space_ewa_program(name);
  return isa::load(text.text, text.name);
}

// The inputs of one corner of a surfel, in binary32.
inline void set_inputs(vertex::InputBatch& batch, int vertex, const Surfel& surfel, const glm::vec2& corner) {
  const auto set = [&](SurfelInput input, double x, double y, double z, double w) {
    const double values[4] = {x, y, z, w};
    for (int i = 0; i < 4; ++i) batch.v[input][i][vertex] = static_cast<float>(values[i]);
  };
  set(kPositionInput, surfel.position.x, surfel.position.y, surfel.position.z, 1);
  set(kTangentSInput, surfel.tangent_s.x, surfel.tangent_s.y, surfel.tangent_s.z, 1);
  set(kTangentTInput, surfel.tangent_t.x, surfel.tangent_t.y, surfel.tangent_t.z, 1);
  set(kCornerInput, corner.x, corner.y, 0, 1);
  set(kFilterInput, surfel.sigma, surfel.weight, 0, 1);
  set(kColorInput, surfel.color.r, surfel.color.g, surfel.color.b, 1);
}

inline std::vector<QuadOutput> run_quads(const isa::Program& program, Arithmetic arithmetic,
                                         std::span<const Vec4> constants, std::span<const Surfel> surfels) {
  const vertex::VertexProgram executable(program, arithmetic);
  constexpr std::size_t kQuads = vertex::kBatch / 4;
  std::vector<QuadOutput> outputs(surfels.size());
  vertex::InputBatch in{};
  vertex::OutputBatch out{};
  for (std::size_t first = 0; first < surfels.size(); first += kQuads) {
    const std::size_t quads = std::min(kQuads, surfels.size() - first);
    for (std::size_t i = 0; i < 4 * quads; ++i) {
      set_inputs(in, static_cast<int>(i), surfels[first + i / 4], kCorners[i % 4]);
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
