#include "kernels/reference/volume/procedural.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>

#include "model/stop.h"

namespace splatscope::kernels {
namespace {

constexpr double kPi = std::numbers::pi;

Volume cube(int n) {
  return centered_volume(glm::ivec3(n), glm::dvec3(2.0 / (n - 1)));
}

// 1 inside an ellipsoid, 0 outside, over a rim of about `rim` units.
double ellipsoid(const glm::dvec3& p, const glm::dvec3& center, const glm::dvec3& radii, double rim) {
  const glm::dvec3 q = (p - center) / radii;
  const double length = glm::length(q);
  if (length == 0) return 1;
  // Distance from the surface, to first order: (|q| - 1) / |grad |q||.
  const double distance = (length - 1) * length / glm::length(q / radii);
  return std::clamp(0.5 - distance / rim, 0.0, 1.0);
}

double lerp(double from, double to, double t) {
  return from + (to - from) * t;
}

// In [-1, 1], of a voxel's position: the same on every machine.
double noise(const glm::dvec3& p) {
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  for (const double coordinate : {p.x, p.y, p.z}) {
    state ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(coordinate * 4096)));
    state *= 0xbf58476d1ce4e5b9u;
    state ^= state >> 29;
  }
  return static_cast<double>(state >> 40) / static_cast<double>(1 << 23) - 1;
}

// p.x to the head's left, p.y to its back, p.z up; the skull is about 1.5 units wide.
double head(glm::dvec3 p) {
  constexpr double kRim = 0.02;
  const double side = std::abs(p.x);
  const glm::dvec3 q{side, p.y, p.z};  // a head is symmetric
  const auto in = [&](const glm::dvec3& center, const glm::dvec3& radii) {
    return ellipsoid(q, center, radii, kRim);
  };
  // Skin: cranium, face, neck, nose and an ear.
  double flesh = in({0, 0.05, 0.15}, {0.76, 0.92, 0.78});
  flesh = std::max(flesh, in({0, -0.30, -0.35}, {0.56, 0.56, 0.72}));
  flesh = std::max(flesh, in({0, 0.18, -0.75}, {0.42, 0.46, 0.60}));
  flesh = std::max(flesh, in({0, -0.90, -0.25}, {0.11, 0.13, 0.20}));
  flesh = std::max(flesh, in({0.78, 0.10, -0.15}, {0.05, 0.13, 0.20}));
  // Bone: a hollow cranium, cheeks, jaw, spine; then its openings.
  const double brain_case = in({0, 0.06, 0.16}, {0.70, 0.85, 0.71});
  const double brain = in({0, 0.06, 0.17}, {0.63, 0.78, 0.64});
  double bone = std::min(brain_case, 1 - brain);
  const double face = in({0, -0.40, -0.30}, {0.46, 0.38, 0.40});
  bone = std::max(bone, std::min(face, 1 - in({0, -0.20, -0.40}, {0.34, 0.40, 0.32})));
  bone = std::max(bone, in({0.46, -0.42, -0.26}, {0.14, 0.22, 0.06}));
  double jaw =
      std::min(in({0, -0.28, -0.72}, {0.38, 0.50, 0.17}), 1 - in({0, -0.16, -0.68}, {0.32, 0.48, 0.25}));
  jaw = std::min(jaw, std::clamp((0.05 - q.y) / kRim, 0.0, 1.0));  // open behind
  jaw = std::max(jaw, in({0.35, -0.02, -0.47}, {0.045, 0.13, 0.32}));
  bone = std::max(bone, jaw);
  bone = std::max(
      bone, std::min(in({0, 0.22, -0.8}, {0.15, 0.15, 0.7}), 0.75 + 0.25 * std::cos(p.z * 2 * kPi / 0.13)));
  bone = std::min(bone, 1 - in({0.22, -0.72, -0.10}, {0.15, 0.26, 0.13}));  // eye sockets
  bone = std::min(bone, 1 - in({0.05, -0.78, -0.36}, {0.06, 0.24, 0.14}));  // nose
  const double teeth =
      std::min(in({0, -0.42, -0.58}, {0.26, 0.32, 0.11}), 1 - in({0, -0.34, -0.58}, {0.20, 0.30, 0.14}));
  const double gaps = 0.5 + 0.5 * std::cos(std::atan2(q.x, -q.y - 0.1) * 44);
  bone = std::max(bone, teeth * (0.55 + 0.45 * gaps));
  double value = flesh * lerp(0.28, 0.36, brain);
  value = lerp(value, 0.85, std::min(bone, flesh));
  const double airways =
      std::max(in({0, -0.30, -0.42}, {0.10, 0.34, 0.09}), in({0, 0.02, -0.9}, {0.08, 0.07, 0.45}));
  value *= 1 - airways * flesh;
  return value;
}

}  // namespace

Volume filled(Volume grid, const std::function<double(const glm::dvec3&)>& value) {
  oneapi::tbb::parallel_for(0, grid.size.z, [&](int z) {
    stop_if_asked();
    for (int y = 0; y < grid.size.y; ++y) {
      for (int x = 0; x < grid.size.x; ++x) {
        const glm::ivec3 voxel{x, y, z};
        grid.values[grid.index(voxel)] = static_cast<float>(value(grid.position(voxel)));
      }
    }
  });
  return grid;
}

Volume marschner_lobb(int n) {
  constexpr double kFrequency = 6, kAlpha = 0.25;
  return filled(cube(n), [](const glm::dvec3& p) {
    const double rho = std::cos(2 * kPi * kFrequency * std::cos(0.5 * kPi * std::hypot(p.x, p.y)));
    return (1 - std::sin(0.5 * kPi * p.z) + kAlpha * (1 + rho)) / (2 * (1 + kAlpha));
  });
}

Volume concentric_shells(int n, int shells) {
  return filled(cube(n), [&](const glm::dvec3& p) {
    const double r = glm::length(p);
    const double c = std::cos(kPi * shells * r);
    return r < 1 ? c * c : 0.0;
  });
}

Volume constant_volume(const glm::ivec3& size, const glm::dvec3& spacing) {
  Volume volume = centered_volume(size, spacing);
  std::ranges::fill(volume.values, 1.0f);
  return volume;
}

double zebra(double x, double y, double period) {
  // Lines of equal phase, bent by two slow waves; sharpened into stripes with rims of a tenth of a period.
  const double bend = 0.16 * std::sin(2.1 * y + 0.7) + 0.07 * std::sin(5.3 * y - 2.3 * x);
  const double wave = std::sin(2 * kPi * (0.8 * x + 0.6 * y + bend) / period);
  return 0.5 + 0.5 * std::clamp(wave / 0.3, -1.0, 1.0);
}

Volume zebra_texture(int columns, int rows, int layers, double period) {
  const double dx = 2.0 / columns, dy = 2.0 / rows;
  return filled(centered_volume({columns, rows, layers}, {dx, dy, std::min(dx, dy)}),
                [&](const glm::dvec3& p) { return zebra(p.x, p.y, period); });
}

Volume head_stand_in(const glm::ivec3& size) {
  const glm::dvec3 spacing{2.0 / size.x, 2.0 / size.y, 2.0 / size.z};
  return filled(centered_volume(size, spacing), [](const glm::dvec3& p) {
    const double value = head(p);
    return std::clamp(value + (value > 0 ? 0.02 : 0.004) * noise(p), 0.0, 1.0);
  });
}

}  // namespace splatscope::kernels
