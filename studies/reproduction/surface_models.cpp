#include "studies/reproduction/surface_models.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "kernels/sphere_points.h"
#include "traces/models/patterns.h"

namespace splatscope::studies {
namespace {

using glm::dmat3;
using glm::dvec3;
using kernels::Surfel;

const double kReach = std::numbers::sqrt2;  // of a surfel, in spacings: to the diagonal neighbour
const dvec3 kLight = glm::normalize(dvec3(0.4, 0.8, 0.5));

double lit(const dvec3& normal) {
  return 0.3 + 0.7 * std::max(0.0, glm::dot(normal, kLight));
}

// One of `points` spread evenly over the unit sphere, with tangents as long as they are far apart. s x t
// points outward.
Surfel sphere_surfel(int i, int points) {
  Surfel surfel;
  const auto [place, along] = kernels::sphere_point(i, points);
  surfel.position = place;
  surfel.tangent_s = kReach * kernels::sphere_spacing(points) * along;
  surfel.tangent_t = glm::cross(surfel.position, surfel.tangent_s);
  return surfel;
}

// An ellipsoid: the image of the unit sphere. The surfels' filters are stretched with it.
struct Part {
  dmat3 axes;  // half axes as columns, right-handed
  dvec3 center;
  dvec3 color;
  double opacity = 1;

  // About proportional to the surface: the mean of the products of two half axes.
  double area() const {
    const double a = glm::length(axes[0]), b = glm::length(axes[1]), c = glm::length(axes[2]);
    return 4 * std::numbers::pi / 3 * (a * b + b * c + c * a);
  }
};

Part ellipsoid(const dvec3& center, const dvec3& half_axes, const dvec3& color, double opacity = 1) {
  return {dmat3(half_axes.x, 0, 0, 0, half_axes.y, 0, 0, 0, half_axes.z), center, color, opacity};
}

// About y by an angle in degrees.
Part turned(Part part, double degrees) {
  const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  part.axes = dmat3(c, 0, -s, 0, 1, 0, s, 0, c) * part.axes;
  return part;
}

void add(const Part& part, int points, SurfaceModel& model) {
  for (int i = 0; i < points; ++i) {
    Surfel surfel = sphere_surfel(i, points);
    surfel.position = part.axes * surfel.position + part.center;
    surfel.tangent_s = part.axes * surfel.tangent_s;
    surfel.tangent_t = part.axes * surfel.tangent_t;
    const dvec3 normal = glm::normalize(glm::cross(surfel.tangent_s, surfel.tangent_t));
    surfel.color = lit(normal) * part.color;
    model.surfels.push_back(surfel);
    model.opacities.push_back(part.opacity);
  }
}

std::vector<Part> helicopter() {
  const dvec3 hull(0.75, 0.78, 0.8), dark(0.2, 0.2, 0.25), red(0.8, 0.15, 0.1), glass(0.55, 0.75, 0.95);
  std::vector<Part> parts{
      ellipsoid({0.75, 0, 0}, {0.95, 0.6, 0.55}, glass, 0.3),
      ellipsoid({-0.35, 0.05, 0}, {0.8, 0.58, 0.5}, hull),
      ellipsoid({0.75, -0.2, 0.22}, {0.18, 0.28, 0.14}, red),
      ellipsoid({0.75, -0.2, -0.22}, {0.18, 0.28, 0.14}, red),
      ellipsoid({1.2, -0.3, 0}, {0.12, 0.12, 0.4}, dark),
      ellipsoid({-2.0, 0.2, 0}, {1.3, 0.13, 0.12}, hull),
      ellipsoid({-3.2, 0.5, 0}, {0.25, 0.5, 0.04}, red),
      ellipsoid({-3.0, 0.25, 0}, {0.18, 0.04, 0.5}, hull),
      ellipsoid({-0.2, 0.75, 0}, {0.09, 0.25, 0.09}, dark),
      ellipsoid({-3.2, 0.5, 0.12}, {0.45, 0.06, 0.02}, dark),
      ellipsoid({-3.2, 0.5, 0.12}, {0.06, 0.45, 0.02}, dark),
  };
  for (const double side : {-0.5, 0.5}) {
    parts.push_back(ellipsoid({0.2, -0.95, side}, {1.2, 0.04, 0.04}, dark));
    for (const double x : {-0.3, 0.6}) parts.push_back(ellipsoid({x, -0.7, side}, {0.04, 0.26, 0.04}, dark));
  }
  for (const double angle : {20.0, 80.0, 140.0})
    parts.push_back(turned(ellipsoid({-0.2, 1.0, 0}, {2.6, 0.03, 0.12}, dark), angle));
  return parts;
}

// Object units over the square from -1 to 1, from several octaves of ridges.
double height_at(double x, double z) {
  double height = 0.9 * std::exp(-4 * (x * x + z * z)), size = 0.35, frequency = 1.7;
  for (int octave = 0; octave < 8; ++octave, size *= 0.47, frequency *= 2.1)
    height += size * (0.5 - std::abs(traces::noise(frequency * dvec3(x, 0.37 * octave, z))));
  return height;
}

dvec3 ground_color(const dvec3& p, const dvec3& normal) {
  const double grain = 0.5 + 0.5 * traces::noise(90.0 * p);
  const dvec3 snow(0.95, 0.96, 1.0), rock(0.45, 0.4, 0.36), meadow(0.25, 0.42, 0.15);
  const double flat = glm::smoothstep(0.55, 0.75, normal.y + 0.1 * (grain - 0.5));
  const double high = glm::smoothstep(0.35, 0.55, p.y + 0.15 * (grain - 0.5));
  return glm::mix(rock, glm::mix(meadow, snow, high), flat) * (0.75 + 0.25 * grain);
}

}  // namespace

SurfaceModel head_model(int points, int size) {
  SurfaceModel model{"scanned head", "an ellipsoid with features of noise", {}, {}, 0, {}};
  model.surfels.resize(static_cast<std::size_t>(points));
  const auto surface = [](const dvec3& u) {
    const double features = 0.08 * traces::noise(2.5 * u) + 0.02 * traces::noise(9.0 * u);
    return (1 + features) * dvec3(0.75, 1, 0.85) * u;
  };
  for (int i = 0; i < points; ++i) {
    Surfel& surfel = model.surfels[static_cast<std::size_t>(i)];
    surfel = sphere_surfel(i, points);
    const dvec3 u = surfel.position;
    const auto along = [&](const dvec3& tangent) {  // the surface's derivative
      return 0.5 * (surface(glm::normalize(u + tangent)) - surface(glm::normalize(u - tangent)));
    };
    surfel.position = surface(u);
    surfel.tangent_s = along(surfel.tangent_s);
    surfel.tangent_t = along(surfel.tangent_t);
    const dvec3 normal = glm::normalize(glm::cross(surfel.tangent_s, surfel.tangent_t));
    const double spots = 0.85 + 0.15 * traces::noise(40.0 * u);
    surfel.color = lit(normal) * spots * dvec3(0.95, 0.75, 0.62);
  }
  model.spacing = kernels::sphere_spacing(points);
  model.view = kernels::look_at({2.2, 1.2, 5.3}, {0, 0, 0}, {0, 1, 0}, 22, size, size, 3, 9);
  return model;
}

SurfaceModel terrain_model(int points, int size) {
  SurfaceModel model{"Matterhorn", "a height field of noise", {}, {}, 0, {}};
  const auto rows = static_cast<std::int64_t>(std::sqrt(points));
  const double step_z = 2.0 / static_cast<double>(rows);
  model.spacing = step_z;
  model.surfels.reserve(static_cast<std::size_t>(points));
  for (std::int64_t row = 0; row < rows; ++row) {
    // Where `points` is no square, some rows have more of them than others.
    const std::int64_t columns = points * (row + 1) / rows - points * row / rows;
    const double step_x = 2.0 / static_cast<double>(columns);
    const double z = step_z * (static_cast<double>(row) + 0.5) - 1;
    for (std::int64_t column = 0; column < columns; ++column) {
      Surfel& surfel = model.surfels.emplace_back();
      const double x = step_x * (static_cast<double>(column) + 0.5) - 1;
      const double height = height_at(x, z);
      surfel.position = {x, height, z};
      surfel.tangent_s = kReach * dvec3(0, height_at(x, z + step_z) - height, step_z);
      surfel.tangent_t = kReach * dvec3(step_x, height_at(x + step_x, z) - height, 0);
      const dvec3 normal = glm::normalize(glm::cross(surfel.tangent_s, surfel.tangent_t));
      surfel.color = lit(normal) * ground_color(surfel.position, normal);
    }
  }
  model.view = kernels::look_at({0.9, 1.3, 2.3}, {0, 0.35, 0}, {0, 1, 0}, 38, size, size, 0.5, 6);
  return model;
}

SurfaceModel helicopter_model(int points, int size) {
  SurfaceModel model{"helicopter", "ellipsoids in its parts' places, the cabin of glass", {}, {}, 0, {}};
  const std::vector<Part> parts = helicopter();
  double area = 0;
  for (const Part& part : parts) area += part.area();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int left = points - static_cast<int>(model.surfels.size());
    const int share = static_cast<int>(points * parts[i].area() / area);
    add(parts[i], i + 1 == parts.size() ? left : share, model);
  }
  model.spacing = std::sqrt(area / points);
  model.view = kernels::look_at({5.5, 2.2, 7.5}, {-0.6, 0.05, 0}, {0, 1, 0}, 27, size, size, 4, 16);
  return model;
}

}  // namespace splatscope::studies
