#include <array>

#include "traces/models/creatures.h"

namespace splatscope::traces {
namespace {

enum Part : std::uint32_t { kSkin, kEye };

void add_leg(Body& body, const glm::dvec3& hip, const glm::dvec3& knee, const glm::dvec3& foot, int side) {
  const auto at = [side](const glm::dvec3& p) { return on_side(p, side); };
  add_limb(body,
           std::array<Vertebra, 4>{{{at(hip), 0.05},
                                    {at(knee), 0.042},
                                    {at(foot), 0.034},
                                    {at(foot + glm::dvec3(0.03, -0.005, 0.01)), 0.03}}},
           {kSkin, 0.05});
  for (int toe = 0; toe < 4; ++toe) {
    const glm::dvec3 tip = foot + glm::dvec3(0.10 - 0.012 * toe, -0.012, -0.05 + 0.045 * toe);
    add_limb(body, std::array<Vertebra, 2>{{{at(foot + glm::dvec3(0.02, 0, 0.01)), 0.02}, {at(tip), 0.011}}},
             {kSkin, 0.015}, 2);
  }
}

}  // namespace

Model salamander() {
  Body body;
  add_limb(body,
           std::array<Vertebra, 11>{{{{0.97, 0.115, 0.20}, 0.055},
                                     {{0.86, 0.13, 0.17}, 0.095},
                                     {{0.70, 0.12, 0.09}, 0.075},
                                     {{0.50, 0.135, 0.00}, 0.105},
                                     {{0.20, 0.15, -0.08}, 0.125},
                                     {{-0.12, 0.135, -0.02}, 0.105},
                                     {{-0.32, 0.115, 0.07}, 0.080},
                                     {{-0.56, 0.09, 0.15}, 0.056},
                                     {{-0.80, 0.065, 0.09}, 0.036},
                                     {{-1.00, 0.045, -0.06}, 0.019},
                                     {{-1.08, 0.035, -0.18}, 0.008}}},
           {kSkin, 0.04}, 8);
  add_ball(body, {0.90, 0.165, 0.255}, 0.03, {kSkin, 0.03});
  add_ball(body, {0.93, 0.165, 0.115}, 0.03, {kSkin, 0.03});
  add_ball(body, {0.905, 0.185, 0.262}, 0.024, {kEye});
  add_ball(body, {0.935, 0.185, 0.108}, 0.024, {kEye});
  add_leg(body, {0.52, 0.12, 0.05}, {0.50, 0.13, 0.25}, {0.62, 0.025, 0.33}, 1);
  add_leg(body, {0.52, 0.12, 0.05}, {0.42, 0.13, 0.25}, {0.46, 0.025, 0.35}, -1);
  add_leg(body, {-0.12, 0.11, 0.05}, {-0.10, 0.13, 0.27}, {-0.20, 0.025, 0.37}, 1);
  add_leg(body, {-0.10, 0.11, 0.05}, {-0.02, 0.13, 0.27}, {0.06, 0.025, 0.34}, -1);
  return {surface_of(body, 0.006),
          painted({{Pattern::spots, {0.13f, 0.13f, 0.16f}, {1.0f, 0.82f, 0.10f}, 0.085},
                   {Pattern::plain, {0.35f, 0.05f, 0.03f}, {0, 0, 0}}})};
}

}  // namespace splatscope::traces
