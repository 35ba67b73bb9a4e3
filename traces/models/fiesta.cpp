#include <array>
#include <cmath>
#include <numbers>

#include "traces/models/creatures.h"

namespace splatscope::traces {
namespace {

enum Part : std::uint32_t {
  kTable,
  kSkin,
  kHat,
  kPot,
  kCactus,
  kFlower,
  kGuitar,
  kBottle,
  kTrousers,
  kFirstPoncho
};
constexpr std::uint32_t kPonchos = 4;

// Where a figure stands and where it looks: its own x is to its left, z ahead.
struct Place {
  glm::dvec3 foot{};
  double heading = 0;  // radians about +y
  glm::dvec3 operator()(double x, double y, double z) const {
    const double c = std::cos(heading), s = std::sin(heading);
    return foot + glm::dvec3(c * x + s * z, y, c * z - s * x);
  }
};

void add_sombrero(Body& body, const Place& at, double y, double tilt) {
  const glm::dvec3 up = at(0, 1, tilt) - at(0, 0, 0);
  const double length = std::sqrt(1 + tilt * tilt);
  add_ball(body, at(0, y, 0), 0.17, {kHat, 0, up / length, 8});
  add_limb(
      body,
      std::array<Vertebra, 3>{
          {{at(0, y, 0), 0.075}, {at(0, y + 0.06, 0.06 * tilt), 0.06}, {at(0, y + 0.13, 0.13 * tilt), 0.03}}},
      {kHat, 0.02}, 3);
}

// `swing` from -1 to 1: the step of the dance.
void add_dancer(Body& body, const Place& at, std::uint32_t poncho, double swing) {
  for (int side : {1, -1}) {
    const double lift = side * swing > 0 ? 0.08 * std::abs(swing) : 0;
    add_limb(body,
             std::array<Vertebra, 4>{{{at(0.05 * side, 0.30, 0), 0.05},
                                      {at(0.065 * side, 0.17 + 0.5 * lift, 0.7 * lift), 0.042},
                                      {at(0.06 * side, 0.035 + lift, -0.3 * lift), 0.032},
                                      {at(0.065 * side, 0.028 + lift, 0.06 - 0.3 * lift), 0.027}}},
             {kTrousers, 0.02}, 4);
    const double raise = 0.22 + 0.14 * side * swing;
    add_limb(body,
             std::array<Vertebra, 3>{{{at(0.08 * side, 0.50, 0), 0.04},
                                      {at(0.20 * side, 0.46, 0.05), 0.032},
                                      {at(0.27 * side, 0.40 + raise, 0.08), 0.027}}},
             {kFirstPoncho + poncho, 0.02}, 4);
    add_ball(body, at(0.275 * side, 0.43 + raise, 0.085), 0.034, {kSkin, 0.01});
  }
  add_limb(body,
           std::array<Vertebra, 4>{{{at(0, 0.54, 0), 0.05},
                                    {at(0, 0.48, 0), 0.095},
                                    {at(0, 0.36, 0), 0.125},
                                    {at(0, 0.27, 0), 0.145}}},
           {kFirstPoncho + poncho, 0.02, at(0, 0, 1) - at(0, 0, 0), 1.3}, 4);
  add_ball(body, at(0, 0.63, 0.005), 0.075, {kSkin, 0.02});
  add_ball(body, at(0, 0.62, 0.082), 0.017, {kSkin, 0.01});
  add_sombrero(body, at, 0.685, -0.15);
}

void add_cactus(Body& body, const Place& at) {
  add_limb(body,
           std::array<Vertebra, 3>{{{at(0, 0.06, 0), 0.11}, {at(0, 0.13, 0), 0.14}, {at(0, 0.20, 0), 0.15}}},
           {kPot}, 4);
  add_limb(body,
           std::array<Vertebra, 3>{{{at(0, 0.2, 0), 0.085}, {at(0, 0.6, 0), 0.095}, {at(0, 0.92, 0), 0.07}}},
           {kCactus}, 6);
  add_limb(body,
           std::array<Vertebra, 4>{{{at(0, 0.45, 0), 0.05},
                                    {at(0.18, 0.47, 0), 0.055},
                                    {at(0.23, 0.6, 0), 0.052},
                                    {at(0.23, 0.76, 0), 0.042}}},
           {kCactus, 0.03}, 5);
  add_limb(body,
           std::array<Vertebra, 4>{{{at(0, 0.55, 0), 0.05},
                                    {at(-0.17, 0.56, 0.03), 0.05},
                                    {at(-0.21, 0.66, 0.03), 0.046},
                                    {at(-0.21, 0.8, 0.03), 0.038}}},
           {kCactus, 0.03}, 5);
  for (int petal = 0; petal < 6; ++petal) {
    const double angle = petal * std::numbers::pi / 3;
    add_ball(body, at(0.055 * std::cos(angle), 1.0, 0.055 * std::sin(angle)), 0.035, {kFlower, 0.01});
  }
}

void add_guitar(Body& body, const Place& at) {
  const glm::dvec3 flat = at(0, 0, 1) - at(0, 0, 0);
  add_limb(body,
           std::array<Vertebra, 3>{
               {{at(0, 0.12, 0), 0.12}, {at(0.01, 0.21, 0), 0.08}, {at(0.02, 0.29, 0), 0.095}}},
           {kGuitar, 0, flat, 2.8}, 5);
  add_limb(body, std::array<Vertebra, 2>{{{at(0.03, 0.36, 0.01), 0.018}, {at(0.06, 0.64, 0.01), 0.018}}},
           {kBottle, 0.01}, 2);
}

void add_bottle(Body& body, const Place& at) {
  add_limb(body,
           std::array<Vertebra, 5>{{{at(0, 0.06, 0), 0.055},
                                    {at(0, 0.16, 0), 0.055},
                                    {at(0, 0.22, 0), 0.04},
                                    {at(0, 0.27, 0), 0.02},
                                    {at(0, 0.34, 0), 0.02}}},
           {kBottle}, 4);
}

std::vector<Coat> coats() {
  return {{Pattern::checker, {0.95f, 0.93f, 0.88f}, {0.75f, 0.12f, 0.12f}, 0.10},
          {Pattern::plain, {0.80f, 0.55f, 0.38f}, {}},
          {Pattern::scales, {0.98f, 0.86f, 0.45f}, {0.45f, 0.28f, 0.05f}, 0.025},
          {Pattern::zebra, {0.85f, 0.40f, 0.20f}, {0.95f, 0.85f, 0.65f}, 0.05},
          {Pattern::scales, {0.35f, 0.75f, 0.30f}, {0.02f, 0.15f, 0.05f}, 0.03},
          {Pattern::plain, {0.98f, 0.35f, 0.60f}, {}},
          {Pattern::marble, {0.85f, 0.55f, 0.22f}, {0.35f, 0.15f, 0.04f}, 0.06},
          {Pattern::stripes, {0.25f, 0.50f, 0.25f}, {0.90f, 0.88f, 0.70f}, 0.06},
          {Pattern::stripes, {0.90f, 0.88f, 0.82f}, {0.45f, 0.45f, 0.55f}, 0.03},
          {Pattern::stripes, {0.95f, 0.30f, 0.15f}, {0.98f, 0.90f, 0.30f}, 0.028},
          {Pattern::stripes, {0.15f, 0.45f, 0.85f}, {0.98f, 0.95f, 0.90f}, 0.028},
          {Pattern::zebra, {0.65f, 0.20f, 0.65f}, {0.40f, 0.90f, 0.70f}, 0.04},
          {Pattern::checker, {0.10f, 0.60f, 0.30f}, {0.95f, 0.90f, 0.20f}, 0.03}};
}

}  // namespace

Model fiesta() {
  Body body;
  add_ball(body, {0, -0.05, 0}, 1.12, {kTable, 0, {0, 1, 0}, 22});
  add_limb(body, std::array<Vertebra, 3>{{{{0, -0.08, 0}, 0.14}, {{0, -0.3, 0}, 0.07}, {{0, -0.5, 0}, 0.16}}},
           {kGuitar, 0.03}, 6);
  add_cactus(body, {{0, 0, -0.05}, 0.3});
  constexpr int kDancers = 7;
  for (int i = 0; i < kDancers; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.25) / kDancers;
    const Place place{{0.68 * std::sin(angle), 0.0, 0.68 * std::cos(angle)},
                      angle + (i % 2 == 0 ? 0.5 : -0.6)};
    add_dancer(body, place, static_cast<std::uint32_t>(i) % kPonchos, i % 3 - 0.9);
  }
  add_guitar(body, {{0.24, -0.0, 0.36}, 0.4});
  add_bottle(body, {{-0.12, 0, 0.42}, 0});
  add_bottle(body, {{-0.30, 0, 0.28}, 0});
  add_bottle(body, {{0.36, 0, -0.22}, 0});
  return {surface_of(body, 0.007), painted(coats())};
}

}  // namespace splatscope::traces
