#include "kernels/object_space_ewa/splat_accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splatscope::kernels {
namespace {

// Largest distance of corresponding corners in pixels under `to_pixels`, for the best symmetry of the square.
template <typename ToPixels>
double corner_error(const std::array<glm::dvec2, 4>& u, const std::array<glm::dvec2, 4>& y,
                    const glm::dmat2& axes, const ToPixels& to_pixels) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t symmetry = 0; symmetry < 8; ++symmetry) {
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t image = symmetry < 4 ? (i + symmetry) % 4 : (symmetry - i) % 4;
      worst = std::max(worst, glm::distance(to_pixels(u[i]), to_pixels(axes * y[image])));
    }
    best = std::min(best, worst);
  }
  return best;
}

// The parallelogram with the same variance matrix as `axes` that is nearest to `measured`: every factor of a
// variance matrix is `axes` times an orthogonal matrix.
glm::dmat2 nearest_factor(const glm::dmat2& measured, const glm::dmat2& axes) {
  glm::dmat2 turn = glm::inverse(axes) * measured;
  const double mirror = glm::determinant(turn) < 0 ? -1.0 : 1.0;
  turn[1] *= mirror;
  const double angle = std::atan2(turn[0][1] - turn[1][0], turn[0][0] + turn[1][1]);
  return axes * glm::dmat2{{std::cos(angle), std::sin(angle)},
                           {-mirror * std::sin(angle), mirror * std::cos(angle)}};
}

// The same in the window, where every corner is at least half as far away as the surfel's centre; 0
// elsewhere. A corner near the eye's plane has no bound: the projection magnifies without one.
double window_corner_error(const View& view, const Surfel& surfel, const std::array<glm::dvec2, 4>& u,
                           const std::array<glm::dvec2, 4>& y, const glm::dmat2& axes) {
  const glm::dvec3 o = view.camera_space(surfel.position);
  const glm::dvec3 s = view.camera_direction(surfel.tangent_s);
  const glm::dvec3 t = view.camera_direction(surfel.tangent_t);
  for (const glm::dvec2& corner : u) {
    if (o.z + corner.x * s.z + corner.y * t.z < 0.5 * o.z) return 0;
  }
  return corner_error(u, y, axes, [&](const glm::dvec2& c) { return view.window(o + c.x * s + c.y * t); });
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

// Programs that promise the principal axes; the others may have any factor of the variance matrix.
bool has_principal_axes(const SplatProgram& program) {
  return program.name == "paper" || program.name == "plain";
}

}  // namespace

glm::dmat2 measured_axes(const std::array<glm::dvec2, 4>& u, const std::array<glm::dvec2, 4>& y) {
  return {(u[1] - u[0] + u[2] - u[3]) / (y[1] - y[0] + y[2] - y[3]).x,
          (u[3] - u[0] + u[2] - u[1]) / (y[3] - y[0] + y[2] - y[1]).y};
}

double deviation_error(const glm::dmat2& measured, const glm::dmat2& exact) {
  const glm::dmat2 ratio = glm::inverse(exact) * measured;
  const glm::dmat2 variance = ratio * glm::transpose(ratio);
  const double mean = 0.5 * (variance[0][0] + variance[1][1]);
  const double spread = std::hypot(0.5 * (variance[0][0] - variance[1][1]), variance[0][1]);
  return std::max(std::sqrt(mean + spread) - 1.0, 1.0 - std::sqrt(std::max(0.0, mean - spread)));
}

SplatErrors splat_errors(const SplatProgram& program, Arithmetic arithmetic, std::uint32_t seed, int count,
                         const SurfelRanges& ranges) {
  const bool prefilter = program.name != "plain";
  const View view = test_view();
  std::mt19937 generator(seed);
  const std::vector<Surfel> surfels =
      random_surfels(view, ranges, static_cast<std::size_t>(count), generator);
  const auto quads = run_quads(program, arithmetic, view, 0.0, surfels);
  SplatErrors errors;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const Surfel& surfel = surfels[i];
    const SurfelFilter filter = *surfel_filter(view, surfel, prefilter);
    const std::array<glm::dvec2, 4> u = tangent_plane(view, surfel, quads[i]);
    const std::array<glm::dvec2, 4> y = gaussian_coordinates(quads[i]);
    const glm::dmat2 measured = measured_axes(u, y);
    const double weight = surfel.weight * 0.5 * std::numbers::inv_pi / std::sqrt(filter.determinant);
    errors.deviation = std::max(errors.deviation, deviation_error(measured, filter.axes));
    errors.weight = std::max(errors.weight, std::abs(quads[i][0].diffuse.w / weight - 1.0));
    glm::dmat2 axes = filter.axes;
    if (!has_principal_axes(program)) {
      axes = nearest_factor(measured, axes);
    } else if (prefilter && anisotropy(filter, surfel.sigma) < kRound) {
      continue;
    }
    errors.corner = std::max(
        errors.corner, corner_error(u, y, axes, [&](const glm::dvec2& c) { return filter.jacobian * c; }));
    errors.window_corner = std::max(errors.window_corner, window_corner_error(view, surfel, u, y, axes));
    ++errors.corners_compared;
  }
  return errors;
}

}  // namespace splatscope::kernels
