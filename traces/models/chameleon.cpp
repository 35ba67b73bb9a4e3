#include <array>
#include <cmath>
#include <numbers>

#include "traces/models/creatures.h"

namespace splatscope::traces {
namespace {

enum Part : std::uint32_t { kSkin, kBranch, kEyelid, kPupil, kLimb };

void add_tail(Body& body) {
  constexpr int kSteps = 26;
  constexpr double kTurns = 2.4;
  const glm::dvec3 middle(-0.66, -0.02, 0);
  std::vector<Vertebra> spine = {{{-0.34, 0.30, 0}, 0.11}, {{-0.50, 0.28, 0}, 0.08}};
  for (int i = 0; i <= kSteps; ++i) {
    const double done = static_cast<double>(i) / kSteps;
    const double angle = std::numbers::pi / 2 + 2 * std::numbers::pi * kTurns * done;
    const double ring = 0.27 * (1 - 0.83 * done);
    spine.push_back(
        {middle + ring * glm::dvec3(std::cos(angle), std::sin(angle), 0) + glm::dvec3(0, 0, 0.02 * done),
         0.062 - 0.046 * done});
  }
  add_limb(body, spine, {kSkin, 0.02}, 3);
}

void add_leg(Body& body, const glm::dvec3& hip, const glm::dvec3& knee, const glm::dvec3& foot, int side) {
  const auto at = [side](const glm::dvec3& p) { return on_side(p, side); };
  add_limb(body, std::array<Vertebra, 3>{{{at(hip), 0.06}, {at(knee), 0.042}, {at(foot), 0.034}}},
           {kLimb, 0.035});
  for (double along : {-0.05, -0.015, 0.03, 0.06}) {  // grasping the branch
    const glm::dvec3 tip = foot + glm::dvec3(along, -0.09, -0.02);
    add_limb(
        body,
        std::array<Vertebra, 3>{
            {{at(foot), 0.024}, {at(foot + glm::dvec3(0.7 * along, -0.03, 0.022)), 0.021}, {at(tip), 0.014}}},
        {kLimb, 0.01}, 3);
  }
}

}  // namespace

Model chameleon() {
  Body body;
  add_limb(body,
           std::array<Vertebra, 7>{{{{0.62, 0.33, 0}, 0.12},
                                    {{0.46, 0.31, 0}, 0.15},
                                    {{0.28, 0.31, 0}, 0.20},
                                    {{0.04, 0.33, 0}, 0.235},
                                    {{-0.18, 0.33, 0}, 0.20},
                                    {{-0.34, 0.31, 0}, 0.14},
                                    {{-0.44, 0.29, 0}, 0.10}}},
           {kSkin, 0, {0, 0, 1}, 1.6});
  add_limb(
      body,
      std::array<Vertebra, 3>{{{{0.62, 0.34, 0}, 0.115}, {{0.76, 0.315, 0}, 0.085}, {{0.86, 0.29, 0}, 0.05}}},
      {kSkin, 0.06});
  add_limb(
      body,
      std::array<Vertebra, 3>{{{{0.74, 0.40, 0}, 0.05}, {{0.58, 0.49, 0}, 0.08}, {{0.47, 0.53, 0}, 0.04}}},
      {kSkin, 0.05, {0, 0, 1}, 2.5});
  add_tail(body);
  for (int i = 0; i < 17; ++i) {  // the crest along the back
    const double x = 0.42 - 0.05 * i;
    const double y = 0.33 + 0.235 * std::sqrt(std::max(0.0, 1 - std::pow((x - 0.02) / 0.62, 2)));
    add_limb(body, std::array<Vertebra, 2>{{{{x, y - 0.03, 0}, 0.022}, {{x - 0.015, y + 0.035, 0}, 0.008}}},
             {kSkin, 0.015}, 1);
  }
  for (int side : {1, -1}) {
    add_leg(body, {0.30, 0.20, 0.07}, {0.42, 0.09, 0.17}, {0.33, -0.03, 0.05}, side);
    add_leg(body, {-0.24, 0.24, 0.06}, {-0.10, 0.10, 0.19}, {-0.20, -0.035, 0.05}, side);
    add_ball(body, on_side({0.69, 0.355, 0.095}, side), 0.06, {kEyelid, 0.015});
    add_ball(body, on_side({0.705, 0.36, 0.148}, side), 0.018, {kPupil});
  }
  add_limb(body,
           std::array<Vertebra, 5>{{{{-1.0, -0.16, 0.05}, 0.05},
                                    {{-0.45, -0.11, 0.0}, 0.06},
                                    {{0.1, -0.105, 0.0}, 0.055},
                                    {{0.6, -0.09, 0.0}, 0.06},
                                    {{1.05, -0.04, -0.06}, 0.045}}},
           {kBranch}, 10);
  add_limb(body,
           std::array<Vertebra, 3>{
               {{{0.55, -0.09, 0}, 0.05}, {{0.72, -0.2, 0.12}, 0.035}, {{0.8, -0.32, 0.2}, 0.02}}},
           {kBranch, 0.03});
  const glm::vec3 green(0.45f, 0.85f, 0.25f), dark(0.02f, 0.22f, 0.14f);
  Model model{surface_of(body, 0.006),
              painted({{Pattern::zebra, green, {0.95f, 0.75f, 0.15f}, 0.10},
                       {Pattern::marble, {0.60f, 0.42f, 0.25f}, {0.25f, 0.15f, 0.08f}, 0.09},
                       {Pattern::scales, {0.95f, 0.75f, 0.35f}, {0.35f, 0.15f, 0.05f}, 0.022},
                       {Pattern::plain, {0.03f, 0.03f, 0.03f}, {}},
                       {Pattern::scales, green, dark, 0.03}})};
  // The skin's bands are covered with scales.
  model.paint = [bands = model.paint, dark](const SurfacePoint& point) {
    const glm::vec3 color = bands(point);
    if (point.part != kSkin) return color;
    return color * pattern_color(Pattern::scales, glm::dvec3(point.position) / 0.026, glm::vec3(1), dark);
  };
  return model;
}

}  // namespace splatscope::traces
