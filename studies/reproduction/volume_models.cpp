#include "studies/reproduction/volume_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "kernels/reference/volume/procedural.h"

namespace splatscope::studies {
namespace {

using glm::dvec3;
using kernels::Volume;

glm::ivec3 scaled(const glm::ivec3& size, double scale) {
  return glm::max(glm::ivec3(scale * glm::dvec3(size)), glm::ivec3(4));
}

Volume grid(const glm::ivec3& size, const dvec3& extent) {
  return kernels::centered_volume(size, extent / dvec3(size));
}

// Signed distances, negative inside.
double capsule(const dvec3& p, const dvec3& a, const dvec3& b, double radius) {
  const dvec3 ab = b - a;
  const double along = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::distance(p, a + along * ab) - radius;
}
double box(const dvec3& p, const dvec3& center, const dvec3& half, double rounding) {
  const dvec3 q = glm::abs(p - center) - half + rounding;
  return glm::length(glm::max(q, 0.0)) + std::min(0.0, std::max({q.x, q.y, q.z})) - rounding;
}
double cylinder_y(const dvec3& p, double x, double z, double radius) {
  return std::hypot(p.x - x, p.z - z) - radius;
}
// 1 inside, with a rim of about two voxels as scanners see it.
double solid(double distance) {
  return std::clamp(0.5 - distance / 0.03, 0.0, 1.0);
}

// A block with two bores, a flange, ports, and pins of another metal.
double engine(const dvec3& p) {
  double body = box(p, {0, 0, 0}, {0.62, 0.72, 0.3}, 0.06);
  body = std::min(body, box(p, {0, -0.72, 0}, {0.85, 0.08, 0.36}, 0.03));
  body = std::min(body, capsule(p, {-0.85, 0.3, 0}, {0.85, 0.3, 0}, 0.14));
  for (const double x : {-0.3, 0.3}) {
    body = std::max(body, -cylinder_y(p, x, 0, 0.2));
    body = std::max(body, -capsule(p, {x, 0.45, -0.5}, {x, 0.45, 0.5}, 0.07));
    body = std::max(body, -capsule(p, {x, -0.35, -0.5}, {x, -0.35, 0.5}, 0.07));
  }
  body = std::max(body, -capsule(p, {-1, 0.3, 0}, {1, 0.3, 0}, 0.07));
  double pins = 1;
  for (const double x : {-0.3, 0.3}) {
    pins = std::min(pins, capsule(p, {x, -0.5, 0}, {x, 0.1, 0}, 0.1));
    pins = std::min(pins, capsule(p, {x, 0.25, -0.16}, {x, 0.25, 0.16}, 0.04));
  }
  return std::max(0.6 * solid(body), solid(pins));
}

struct Bone {
  dvec3 a, b;
  double radius;
};
constexpr std::array<Bone, 16> kFoot{{{{0.02, 0.62, 0.62}, {0.02, 0.62, -0.02}, 0.1},  // shin
                                      {{-0.14, 0.66, 0.62}, {-0.14, 0.66, 0.02}, 0.05},
                                      {{0, 0.62, -0.16}, {0, 0.55, -0.18}, 0.13},  // ankle, heel, arch
                                      {{0, 0.8, -0.42}, {0, 0.45, -0.36}, 0.14},
                                      {{0.12, 0.25, -0.3}, {-0.12, 0.3, -0.38}, 0.1},
                                      {{0.2, 0.15, -0.36}, {0.24, -0.4, -0.5}, 0.065},  // rays
                                      {{0.1, 0.15, -0.36}, {0.11, -0.42, -0.52}, 0.05},
                                      {{0, 0.15, -0.38}, {0, -0.38, -0.53}, 0.048},
                                      {{-0.09, 0.17, -0.4}, {-0.11, -0.32, -0.54}, 0.046},
                                      {{-0.18, 0.2, -0.43}, {-0.21, -0.24, -0.55}, 0.045},
                                      {{0.25, -0.47, -0.52}, {0.24, -0.76, -0.56}, 0.055},  // toes
                                      {{0.12, -0.49, -0.55}, {0.11, -0.74, -0.57}, 0.04},
                                      {{0, -0.45, -0.56}, {-0.01, -0.68, -0.58}, 0.038},
                                      {{-0.12, -0.39, -0.57}, {-0.13, -0.6, -0.59}, 0.036},
                                      {{-0.22, -0.31, -0.58}, {-0.23, -0.5, -0.6}, 0.035},
                                      {{0.02, 0.62, 0.62}, {0.02, 0.62, 0.6}, 0.12}}};

// Bones in flesh that follows them.
double foot(const dvec3& p) {
  double bone = 1, flesh = 1;
  for (const Bone& part : kFoot) {
    const double distance = capsule(p, part.a, part.b, part.radius);
    bone = std::min(bone, distance);
    // Melts together over a tenth of a unit.
    const double near = distance - 0.08, blend = std::max(0.1 - std::abs(flesh - near), 0.0) / 0.1;
    flesh = std::min(flesh, near) - 0.025 * blend * blend;
  }
  return std::max(0.3 * solid(flesh), solid(bone));
}

kernels::View view_from(const dvec3& eye, const dvec3& up, double degrees, int frame) {
  return kernels::look_at(eye, {0, 0, 0}, up, degrees, frame, frame, 1, 20);
}

}  // namespace

VolumeModel volume_head(int frame, double scale) {
  VolumeModel model{"head", "ellipsoids for the UNC head", scaled({256, 256, 225}, scale), {}, {}};
  const dvec3 skin(0.9, 0.65, 0.5), bone(0.95, 0.92, 0.85);
  const kernels::TransferFunction transfer({{0.06, {0, skin}},
                                            {0.12, {0.12, skin}},
                                            {0.2, {0.12, skin}},
                                            {0.24, {0, skin}},
                                            {0.5, {0, bone}},
                                            {0.6, {0.4, bone}},
                                            {1.0, {0.5, bone}}});
  model.splats = kernels::grid_splats(kernels::head_stand_in(model.size), transfer, 1, {0.5, 1.0});
  model.view = view_from({-2.6, -4.0, 0.9}, {0, 0, 1}, 27, frame);
  return model;
}

VolumeModel volume_engine(int frame, double scale) {
  VolumeModel model{"engine", "boxes and bores for the UNC engine", scaled({256, 256, 110}, scale), {}, {}};
  const dvec3 casing(0.55, 0.65, 0.75), pins(0.95, 0.6, 0.2);
  const kernels::TransferFunction transfer({{0.1, {0, casing}},
                                            {0.2, {0.15, casing}},
                                            {0.4, {0.15, casing}},
                                            {0.5, {0, casing}},
                                            {0.65, {0, casing}},
                                            {0.75, {0.4, pins}},
                                            {1.0, {0.4, pins}}});
  const Volume volume = kernels::filled(grid(model.size, {2, 2, 2 * 110.0 / 256}), engine);
  model.splats = kernels::grid_splats(volume, transfer, 1, {0.1, 0.45});
  model.view = view_from({1.5, 2.2, 4.0}, {0, 1, 0}, 26, frame);
  return model;
}

VolumeModel volume_foot(int frame, double scale) {
  VolumeModel model{"foot", "capsules for the visible woman's foot", scaled({152, 261, 220}, scale), {}, {}};
  const dvec3 flesh(0.85, 0.5, 0.4), bone(0.95, 0.92, 0.85);
  const kernels::TransferFunction transfer({{0.05, {0, flesh}},
                                            {0.12, {0.12, flesh}},
                                            {0.2, {0.12, flesh}},
                                            {0.28, {0, flesh}},
                                            {0.4, {0, flesh}},
                                            {0.5, {0.4, bone}},
                                            {1.0, {0.45, bone}}});
  const Volume volume = kernels::filled(grid(model.size, {2 * 152.0 / 261, 2, 2 * 220.0 / 261}), foot);
  model.splats = kernels::grid_splats(volume, transfer, 1, {0.4, 0.9});
  model.view = view_from({3.6, -2.6, 1.6}, {0, 0, 1}, 27, frame);
  return model;
}

}  // namespace splatscope::studies
