#include <array>
#include <glm/geometric.hpp>

#include "traces/models/creatures.h"

namespace splatscope::traces {
namespace {

enum Part : std::uint32_t { kThorax, kAbdomen, kLeg, kWing, kEye, kFace };

void add_wing(Body& body, const glm::dvec3& root, const glm::dvec3& tip, double width, int side) {
  const glm::dvec3 from = on_side(root, side), to = on_side(tip, side);
  const glm::dvec3 along = glm::normalize(to - from);
  // A blade: level across, and as steep as its spine.
  const glm::dvec3 across = glm::normalize(glm::dvec3(along.z, 0, -along.x));
  const Flesh flesh{kWing, 0, glm::normalize(glm::cross(along, across)), 11};
  const auto at = [&](double t, double radius) { return Vertebra{glm::mix(from, to, t), radius * width}; };
  add_limb(body, std::array<Vertebra, 5>{{at(0, 0.42), at(0.3, 0.7), at(0.6, 1), at(0.85, 0.9), at(1, 0.55)}},
           flesh);
}

void add_leg(Body& body, double x, double reach, double forward, int side) {
  const auto at = [side](double px, double py, double pz) { return on_side({px, py, pz}, side); };
  add_limb(body,
           std::array<Vertebra, 5>{{{at(x, 0.26, 0.10), 0.034},
                                    {at(x + 0.4 * forward, 0.36, 0.10 + 0.45 * reach), 0.026},
                                    {at(x + 0.8 * forward, 0.10, 0.10 + 0.8 * reach), 0.018},
                                    {at(x + forward, -0.14, 0.10 + reach), 0.014},
                                    {at(x + 1.15 * forward + 0.04, -0.16, 0.16 + reach), 0.012}}},
           {kLeg, 0.01});
}

}  // namespace

Model wasp() {
  Body body;
  add_limb(
      body,
      std::array<Vertebra, 3>{{{{0.44, 0.32, 0}, 0.12}, {{0.28, 0.37, 0}, 0.185}, {{0.10, 0.33, 0}, 0.12}}},
      {kThorax});
  add_limb(body, std::array<Vertebra, 2>{{{{0.12, 0.31, 0}, 0.05}, {{-0.06, 0.30, 0}, 0.035}}},
           {kThorax, 0.05});
  add_limb(body,
           std::array<Vertebra, 6>{{{{-0.06, 0.30, 0}, 0.045},
                                    {{-0.20, 0.31, 0}, 0.15},
                                    {{-0.42, 0.28, 0}, 0.19},
                                    {{-0.66, 0.20, 0}, 0.155},
                                    {{-0.86, 0.10, 0}, 0.075},
                                    {{-0.99, 0.03, 0}, 0.012}}},
           {kAbdomen, 0.02});
  add_limb(body, std::array<Vertebra, 2>{{{{0.46, 0.32, 0}, 0.06}, {{0.56, 0.31, 0}, 0.06}}},
           {kThorax, 0.02});
  add_limb(
      body,
      std::array<Vertebra, 3>{{{{0.60, 0.36, 0}, 0.11}, {{0.63, 0.29, 0}, 0.12}, {{0.65, 0.19, 0}, 0.06}}},
      {kFace, 0.03});
  for (int side : {1, -1}) {
    add_limb(body,
             std::array<Vertebra, 2>{
                 {{on_side({0.62, 0.38, 0.10}, side), 0.062}, {on_side({0.65, 0.27, 0.10}, side), 0.058}}},
             {kEye});
    add_limb(body,
             std::array<Vertebra, 4>{{{on_side({0.68, 0.40, 0.035}, side), 0.018},
                                      {on_side({0.78, 0.54, 0.09}, side), 0.015},
                                      {on_side({0.92, 0.55, 0.17}, side), 0.018},
                                      {on_side({1.02, 0.47, 0.23}, side), 0.013}}},
             {kLeg, 0.01});
    add_limb(body,
             std::array<Vertebra, 2>{
                 {{on_side({0.66, 0.17, 0.03}, side), 0.03}, {on_side({0.70, 0.10, 0.01}, side), 0.015}}},
             {kFace, 0.02});
    add_leg(body, 0.40, 0.34, 0.26, side);
    add_leg(body, 0.27, 0.42, -0.06, side);
    add_leg(body, 0.15, 0.46, -0.38, side);
    add_wing(body, {0.30, 0.50, 0.08}, {-0.38, 0.78, 0.92}, 0.15, side);
    add_wing(body, {0.20, 0.47, 0.08}, {-0.52, 0.58, 0.55}, 0.11, side);
  }
  return {surface_of(body, 0.005),
          painted({{Pattern::zebra, {0.16f, 0.14f, 0.12f}, {0.75f, 0.55f, 0.05f}, 0.11},
                   {Pattern::stripes, {1.0f, 0.80f, 0.08f}, {0.08f, 0.07f, 0.06f}, 0.062, 0},
                   {Pattern::stripes, {0.90f, 0.60f, 0.12f}, {0.25f, 0.14f, 0.05f}, 0.09},
                   {Pattern::marble, {0.80f, 0.85f, 0.90f}, {0.30f, 0.28f, 0.25f}, 0.10},
                   {Pattern::scales, {0.45f, 0.16f, 0.12f}, {0.10f, 0.02f, 0.02f}, 0.02},
                   {Pattern::plain, {0.95f, 0.75f, 0.10f}, {}}})};
}

}  // namespace splatscope::traces
