#include "traces/models/patterns.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace splatscope::traces {
namespace {

constexpr std::array<std::string_view, 8> kNames = {"own",   "plain",  "checker", "stripes",
                                                    "zebra", "marble", "spots",   "scales"};

// Places so far out that a double no longer tells their lattice points apart are all alike.
std::int64_t lattice(double x) {
  return std::abs(x) < 1e15 ? static_cast<std::int64_t>(std::floor(x)) : 0;
}

// 0 to 1, unrelated for neighbouring lattice points.
double chance(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
           static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu ^
           static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-53;
}

double smooth(double t) {
  return t * t * (3 - 2 * t);
}

double step_between(double low, double high, double x) {
  return smooth(glm::clamp((x - low) / (high - low), 0.0, 1.0));
}

// Distance to the nearest of points strewn one to a lattice cell.
double nearest_point(const glm::dvec3& p) {
  const std::int64_t at[] = {lattice(p.x), lattice(p.y), lattice(p.z)};
  double least = 4;
  for (int i = 0; i < 27; ++i) {
    const std::int64_t x = at[0] + i % 3 - 1, y = at[1] + i / 3 % 3 - 1, z = at[2] + i / 9 - 1;
    const glm::dvec3 point(static_cast<double>(x) + chance(x, y, z), static_cast<double>(y) + chance(y, z, x),
                           static_cast<double>(z) + chance(z, x, y));
    least = std::min(least, glm::distance(p, point));
  }
  return least;
}

// How much of the light colour: 0 to 1.
double lightness(Pattern pattern, const glm::dvec3& p) {
  switch (pattern) {
    case Pattern::own:
    case Pattern::plain:
      return 1;
    case Pattern::checker:
      return ((lattice(p.x) + lattice(p.y) + lattice(p.z)) & 1) == 0 ? 1 : 0;
    case Pattern::stripes:
      return (lattice(p.y) & 1) == 0 ? 1 : 0;
    case Pattern::zebra:
      return std::sin(std::numbers::pi * (p.x + 0.9 * noise(0.5 * p))) + 0.25 * noise(p) > 0 ? 1 : 0;
    case Pattern::marble: {
      const double swirl = noise(0.5 * p) + 0.5 * noise(p) + 0.25 * noise(2.0 * p);
      return 1 - std::pow(1 - std::abs(std::sin(std::numbers::pi * (0.5 * p.x + 1.5 * swirl))), 2.0);
    }
    case Pattern::spots:
      return step_between(0.34, 0.42, nearest_point(p));
    case Pattern::scales:
      return 1 - 0.9 * step_between(0.25, 0.75, nearest_point(p));
  }
  return 1;
}

}  // namespace

std::span<const std::string_view> pattern_names() {
  return kNames;
}

bool has_scale(Pattern pattern) {
  return pattern != Pattern::own && pattern != Pattern::plain;
}

double noise(const glm::dvec3& p) {
  const std::int64_t x = lattice(p.x), y = lattice(p.y), z = lattice(p.z);
  const glm::dvec3 at = glm::fract(p);
  const double u = smooth(at.x), v = smooth(at.y), w = smooth(at.z);
  const auto row = [&](int dy, int dz) {
    return glm::mix(chance(x, y + dy, z + dz), chance(x + 1, y + dy, z + dz), u);
  };
  return 2 * glm::mix(glm::mix(row(0, 0), row(1, 0), v), glm::mix(row(0, 1), row(1, 1), v), w) - 1;
}

glm::vec3 pattern_color(Pattern pattern, const glm::dvec3& position, const glm::vec3& light,
                        const glm::vec3& dark) {
  return glm::mix(dark, light, static_cast<float>(lightness(pattern, position)));
}

glm::vec3 pattern_color(Pattern pattern, const glm::dvec3& position) {
  constexpr glm::vec3 kColors[][2] = {
      // light, dark
      {{0.85f, 0.85f, 0.85f}, {0.85f, 0.85f, 0.85f}}, {{0.85f, 0.85f, 0.85f}, {0.85f, 0.85f, 0.85f}},
      {{0.95f, 0.95f, 0.95f}, {0.08f, 0.08f, 0.10f}}, {{0.95f, 0.90f, 0.75f}, {0.65f, 0.12f, 0.10f}},
      {{0.95f, 0.95f, 0.92f}, {0.07f, 0.06f, 0.06f}}, {{0.93f, 0.93f, 0.95f}, {0.20f, 0.25f, 0.40f}},
      {{0.95f, 0.75f, 0.25f}, {0.15f, 0.10f, 0.10f}}, {{0.55f, 0.80f, 0.35f}, {0.05f, 0.20f, 0.10f}}};
  const auto& colors = kColors[static_cast<std::size_t>(pattern)];
  return pattern_color(pattern, position, colors[0], colors[1]);
}

}  // namespace splatscope::traces
