#include "traces/models/parametric.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace splatscope::traces {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

// -1 to 1 across a face of the cube so that the cells of its sphere come out of about equal size.
double across(int i, int cells) {
  if (i == 0 || i == cells) return i == 0 ? -1 : 1;  // exactly, so that faces meet
  return std::tan(std::numbers::pi / 4 * (2.0 * i / cells - 1));
}

glm::dvec3 knot(double angle) {
  const double ring = 0.62 + 0.26 * std::cos(3 * angle);
  return {ring * std::cos(2 * angle), ring * std::sin(2 * angle), 0.26 * std::sin(3 * angle)};
}

}  // namespace

Mesh torus_knot(int steps, int sides) {
  Mesh mesh;
  for (int i = 0; i < steps; ++i) {
    const double angle = kTurn * i / steps;
    const glm::dvec3 center = knot(angle);
    const glm::dvec3 ahead = glm::normalize(knot(angle + 1e-4) - knot(angle - 1e-4));
    // The axis of the torus is nowhere along the knot: a frame that closes.
    const glm::dvec3 out = glm::normalize(glm::cross(ahead, glm::dvec3(0, 0, 1)));
    const glm::dvec3 over = glm::cross(ahead, out);
    for (int j = 0; j < sides; ++j) {
      const double around = kTurn * j / sides;
      mesh.positions.emplace_back(center + 0.14 * (std::cos(around) * out + std::sin(around) * over));
    }
  }
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(i % steps * sides + j % sides); };
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < sides; ++j)
      add_quad(mesh, vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j));
  return mesh;
}

// A cube's faces blown up: no poles, where triangles would have no area.
Mesh sphere(int cells, const std::function<double(const glm::dvec3&)>& radius) {
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 1 : -1;
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        glm::dvec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = side * across(i, cells);
        p[(axis + 2) % 3] = across(j, cells);
        p = glm::normalize(p);
        mesh.positions.emplace_back(radius(p) * p);
      }
    }
    const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (cells + 1) + j); };
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j)
        add_quad(mesh, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
  }
  return mesh;
}

}  // namespace splatscope::traces
