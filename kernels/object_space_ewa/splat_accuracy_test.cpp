#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "kernels/object_space_ewa/quad_runner.h"

// The vertex programs against the double-precision filter, over random surfels.
namespace splatscope::kernels {
namespace {

constexpr double kCutoff = 1.0;
const double kRadius = std::sqrt(2.0 * kCutoff);
constexpr int kCount = 100000;

// Tangent-plane coordinates u of an output vertex: oPos back to camera space, onto the exact tangents.
glm::dvec2 tangent_plane(const View& view, const Surfel& surfel, const glm::vec4& position) {
  const double z = position.w;
  const glm::dvec3 p{static_cast<double>(position.x) * view.width / (2.0 * view.eta),
                     static_cast<double>(position.y) * view.height / (2.0 * view.eta), z};
  const glm::dvec3 d = p - view.camera_space(surfel.position);
  const glm::dvec3 s = view.camera_direction(surfel.tangent_s);
  const glm::dvec3 t = view.camera_direction(surfel.tangent_t);
  const glm::dmat2 gram{{glm::dot(s, s), glm::dot(s, t)}, {glm::dot(s, t), glm::dot(t, t)}};
  return glm::inverse(gram) * glm::dvec2(glm::dot(d, s), glm::dot(d, t));
}

// Rot(theta) Lambda as the four corners show it.
glm::dmat2 measured_axes(const std::array<glm::dvec2, 4>& u) {
  return {(u[1] - u[0] + u[2] - u[3]) / (4.0 * kRadius), (u[3] - u[0] + u[2] - u[1]) / (4.0 * kRadius)};
}

// Largest relative deviation, over every direction of the screen, of the measured standard deviation from the
// exact one: sqrt of the generalised eigenvalues of the two variance matrices, which J does not change.
double deviation_error(const glm::dmat2& measured, const glm::dmat2& exact) {
  const glm::dmat2 ratio = glm::inverse(exact) * measured;
  const glm::dmat2 variance = ratio * glm::transpose(ratio);
  const double mean = 0.5 * (variance[0][0] + variance[1][1]);
  const double spread = std::hypot(0.5 * (variance[0][0] - variance[1][1]), variance[0][1]);
  return std::max(std::sqrt(mean + spread) - 1.0, 1.0 - std::sqrt(std::max(0.0, mean - spread)));
}

// Largest distance of corresponding corners in pixels under `to_pixels`, for the best symmetry of the square.
template <typename ToPixels>
double corner_error(const std::array<glm::dvec2, 4>& u, const glm::dmat2& axes, const ToPixels& to_pixels) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t symmetry = 0; symmetry < 8; ++symmetry) {
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t image = symmetry < 4 ? (i + symmetry) % 4 : (symmetry - i) % 4;
      const glm::dvec2 y = 2.0 * kRadius * (glm::dvec2(kCorners[image]) - 0.5);
      worst = std::max(worst, glm::distance(to_pixels(u[i]), to_pixels(axes * y)));
    }
    best = std::min(best, worst);
  }
  return best;
}

// The same in the window, where every corner is at least half as far away as the surfel's centre; 0
// elsewhere. A corner near the eye's plane has no bound: the projection magnifies without one.
double window_corner_error(const View& view, const Surfel& surfel, const std::array<glm::dvec2, 4>& u,
                           const glm::dmat2& axes) {
  const glm::dvec3 o = view.camera_space(surfel.position);
  const glm::dvec3 s = view.camera_direction(surfel.tangent_s);
  const glm::dvec3 t = view.camera_direction(surfel.tangent_t);
  for (const glm::dvec2& corner : u) {
    if (o.z + corner.x * s.z + corner.y * t.z < 0.5 * o.z) return 0;
  }
  return corner_error(u, axes, [&](const glm::dvec2& c) { return view.window(o + c.x * s + c.y * t); });
}

// Where J^-1 J^-T is a multiple of I, so is M, and its axes are arbitrary: rounding of relative size e turns
// them by about e / anisotropy. Under kRound the corners say nothing and only the variance is compared: there
// the rounding of S and T, some 1e-6, would turn the 140-pixel diagonal of the largest splats by 0.1 pixel
// and more.
constexpr double kRound = 1e-3;
// |t|/(q - 2 sigma^2): V_r = sigma^2 I turns nothing.
double anisotropy(const SurfelFilter& filter, double sigma) {
  const glm::dmat2& m = filter.variance;
  return std::hypot(m[0][0] - m[1][1], 2.0 * m[0][1]) / (m[0][0] + m[1][1] - 2.0 * sigma * sigma);
}

struct Errors {
  double deviation = 0;
  double corner = 0;         // pixels, by the affine map J
  double window_corner = 0;  // pixels, by the projection
  double weight = 0;         // relative, of 1/(2 pi r0 r1)
  int corners_compared = 0;
};

Errors measure(Arithmetic arithmetic, std::string_view program, std::uint32_t seed,
               const SurfelRanges& ranges = {}) {
  const bool prefilter = program == kEwaProgram;
  const View view = test_view();
  std::mt19937 generator(seed);
  const std::vector<Surfel> surfels = random_surfels(view, ranges, kCount, generator);
  const auto quads =
      run_quads(load_program(program), arithmetic, splat_constants(view, kCutoff, 0.0), surfels);
  Errors errors;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const Surfel& surfel = surfels[i];
    const SurfelFilter filter = *surfel_filter(view, surfel, prefilter);
    std::array<glm::dvec2, 4> u;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      u[corner] = tangent_plane(view, surfel, quads[i][corner].position);
    }
    const double weight = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter.determinant);
    errors.deviation = std::max(errors.deviation, deviation_error(measured_axes(u), filter.axes));
    errors.weight = std::max(errors.weight, std::abs(quads[i][0].diffuse.w / weight - 1.0));
    if (prefilter && anisotropy(filter, surfel.sigma) < kRound) continue;
    errors.corner =
        std::max(errors.corner,
                 corner_error(u, filter.axes, [&](const glm::dvec2& c) { return filter.jacobian * c; }));
    errors.window_corner = std::max(errors.window_corner, window_corner_error(view, surfel, u, filter.axes));
    ++errors.corners_compared;
  }
  std::printf(
      "%s, seed %u, %d surfels: standard deviation off by %.2e, weight by %.2e; corners of %d by %.2e "
      "pixels, in "
      "the window by %.2e\n",
      std::string(program).c_str(), seed, kCount, errors.deviation, errors.weight, errors.corners_compared,
      errors.corner, errors.window_corner);
  return errors;
}

TEST(SplatAccuracy, ewa_in_ieee) {
  const Errors errors = measure(Arithmetic::ieee, kEwaProgram, 2002);
  EXPECT_LT(errors.deviation, 0.005);
  EXPECT_LT(errors.weight, 0.005);
  EXPECT_LT(errors.corner, 0.1);
  EXPECT_LT(errors.window_corner, 0.1);
  EXPECT_GT(errors.corners_compared, 99 * kCount / 100);
}

// Not promised by anyone: what the NV20 makes of the program. The bounds are those of ieee, and they hold.
TEST(SplatAccuracy, ewa_in_nv20) {
  const Errors errors = measure(Arithmetic::nv20, kEwaProgram, 2003);
  EXPECT_LT(errors.deviation, 0.005);
  EXPECT_LT(errors.weight, 0.005);
  EXPECT_LT(errors.corner, 0.1);
  EXPECT_LT(errors.window_corner, 0.1);
}

// The guards cost nothing where a surfel is small: 1/1000 pixel.
TEST(SplatAccuracy, ewa_of_tiny_surfels) {
  SurfelRanges ranges;
  ranges.spacing[0] = 1e-3;
  ranges.spacing[1] = 0.05;
  const Errors errors = measure(Arithmetic::ieee, kEwaProgram, 2004, ranges);
  EXPECT_LT(errors.deviation, 0.005);
  EXPECT_LT(errors.corner, 0.1);
  EXPECT_LT(errors.window_corner, 0.1);
}

TEST(SplatAccuracy, plain_in_ieee) {
  const Errors errors = measure(Arithmetic::ieee, kPlainProgram, 2005);
  EXPECT_LT(errors.deviation, 0.005);
  EXPECT_LT(errors.weight, 1e-6);
  EXPECT_LT(errors.corner, 0.001);
}

}  // namespace
}  // namespace splatscope::kernels
