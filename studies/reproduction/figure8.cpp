#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "kernels/object_space_ewa/quad_runner.h"
#include "model/error.h"
#include "studies/reproduction/reproduction.h"

namespace splatscope::studies {
namespace {

// A surfel of two pixels' spacing whose plane is tilted by 70 degrees: the low-pass filter, a circle of one
// pixel in the window, becomes an ellipse about as large as the reconstruction filter (a reconstruction: the
// paper names no view).
kernels::Surfel tilted_surfel(const kernels::View& view) {
  constexpr double kDepth = 10, kTilt = 70 * std::numbers::pi / 180, kTurn = 0.6;
  const double h = 2 * kDepth / view.eta;
  const glm::dvec3 across{1, 0, 0}, along{0, std::cos(kTilt), std::sin(kTilt)};
  kernels::Surfel surfel;
  surfel.position = {0, 0, kDepth};
  surfel.tangent_s = glm::vec3(h * (std::cos(kTurn) * across + std::sin(kTurn) * along));
  surfel.tangent_t = glm::vec3(h * (std::cos(kTurn) * along - std::sin(kTurn) * across));
  return surfel;
}

void add_point(const glm::dvec2& u, Plot::Series& series) {
  series.x.push_back(u.x);
  series.y.push_back(u.y);
}

Plot::Series arrow(const std::string& name, const glm::dvec2& to) {
  return {name, {0, to.x}, {0, to.y}};
}

Plot plane_plot(const std::string& title) {
  return {.title = title, .x_label = "u_s, units of h", .y_label = "u_t, units of h", .same_scale = true};
}

}  // namespace

void reproduce_figure8(Findings& findings, const Progress& /*progress*/) {
  const kernels::View view =
      kernels::rounded(kernels::look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 60.0, 512, 512, 0.1, 1000.0));
  const kernels::Surfel surfel = tilted_surfel(view);
  const auto filter = kernels::surfel_filter(view, surfel, true);
  if (!filter) throw ModelError("the surfel of Fig. 8 has no filter");
  const glm::dmat2 low_pass = glm::inverse(filter->jacobian);

  Plot a = plane_plot("Fig. 8a: a unit reconstruction kernel and the warped low-pass filter");
  a.series = {ellipse("reconstruction kernel, V_r = I", glm::dmat2(1)),
              ellipse("low-pass filter, J^-1 J^-T", low_pass), arrow("(du_s/dx_0, du_t/dx_0)", low_pass[0]),
              arrow("(du_s/dx_1, du_t/dx_1)", low_pass[1])};

  Plot b = plane_plot("Fig. 8b: the resampling filter and the parallelogram of the program");
  b.series = {ellipse("resampling filter, double precision", filter->axes),
              arrow("Rot Lambda (1, 0)", filter->axes[0]), arrow("Rot Lambda (0, 1)", filter->axes[1])};
  const kernels::QuadOutput quad = kernels::run_quads(kernels::splat_program(kernels::kEwaProgram),
                                                      Arithmetic::nv20, view, 0, {&surfel, 1})[0];
  Plot::Series corners{"corners of splat_ewa.vs, nv20", {}, {}};
  const auto u = kernels::tangent_plane(view, surfel, quad);
  for (std::size_t i = 0; i <= u.size(); ++i) add_point(u[i % u.size()], corners);
  const double half_diagonal = std::hypot(corners.x[2] - corners.x[0], corners.y[2] - corners.y[0]) / 2;
  const glm::dvec2 exact = filter->axes * (std::sqrt(2 * kernels::kCutoff) * glm::dvec2(1, 1));
  b.series.push_back(std::move(corners));

  findings.report().heading("Fig. 8: the object-space EWA resampling filter");
  findings.plot("fig8a", a);
  findings.plot("fig8b", b);
  const double error = half_diagonal / glm::length(exact) - 1;
  findings.text(
      fmt::format("fig8: r0 {:.4f}, r1 {:.4f} in units of h; the program's half diagonal is {:.4f}, {:+.1e} "
                  "of it from the exact one\n",
                  glm::length(filter->axes[0]), glm::length(filter->axes[1]), half_diagonal, error));
  findings.result("fig8", {{"r0", glm::length(filter->axes[0])},
                           {"r1", glm::length(filter->axes[1])},
                           {"half_diagonal", half_diagonal},
                           {"half_diagonal_error", error}});
}

}  // namespace splatscope::studies
