#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <numbers>
#include <string_view>

#include "studies/reproduction/zwicker_volumes.h"

// Fig. 9 and 13: single filters.
namespace splatscope::studies {
namespace {

using kernels::Projection;
using kernels::VolumePrefilter;

nlohmann::ordered_json json_of(const Radii& radii) {
  return {radii.larger, radii.smaller};
}

// The ellipse x^T V^-1 x = 1.
Plot::Series ellipse_of(const std::string& name, const glm::dmat2& variance) {
  // A root of V: columns of its Cholesky factor.
  const double a = std::sqrt(variance[0][0]), b = variance[0][1] / a;
  const double c = std::sqrt(std::max(0.0, variance[1][1] - b * b));
  return ellipse(name, glm::dmat2(a, b, 0, c));
}

struct FilterCase {
  std::string_view name, what;
  glm::dvec3 radii;  // of the kernel, pixels where it stands; along x, y, z
};

// A kernel turned by 30 degrees in the picture's plane, one unit of camera space a pixel.
constexpr FilterCase kCases[] = {{"minified", "a spherical kernel, 0.3 pixels", {0.3, 0.3, 0.3}},
                                 {"magnified", "a spherical kernel, 3 pixels", {3, 3, 3}},
                                 {"anisotropic", "3 by 0.3 pixels", {3, 0.3, 0.3}}};

glm::dmat2 reconstruction(const FilterCase& filter) {
  const double turn = std::numbers::pi / 6;
  const glm::dmat3 rotation(std::cos(turn), std::sin(turn), 0, -std::sin(turn), std::cos(turn), 0, 0, 0, 1);
  glm::dmat3 variance(0.0);
  for (int i = 0; i < 3; ++i) variance[i][i] = filter.radii[i] * filter.radii[i];
  kernels::View view;
  view.eta = 1000;
  view.width = view.height = 512;
  const kernels::RaySpace ray = ray_space(view, Projection::perspective, {0, 0, 1000});
  return projected_variance(ray, rotation * variance * glm::transpose(rotation));
}

}  // namespace

AffineError affine_error(double spread, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const glm::dvec3 camera{std::sin(angle), 0, std::cos(angle)};
  kernels::View view;
  view.eta = 1e6;  // fine pixels, without a low-pass
  view.width = view.height = 2;
  view.far_plane = 2;
  const glm::dmat3 variance(spread * spread);
  const auto print = footprint(view, Projection::perspective, VolumePrefilter::none, camera, variance);
  if (!print) return {spread, NAN, NAN};
  constexpr int kSteps = 60;
  const glm::dvec2 step = print->reach(25) / static_cast<double>(kSteps);
  AffineError error{spread, 0, 0};
  double highest = 0, sum = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const glm::dvec2 x = print->center + step * glm::dvec2(i, j);
      const double exact = exact_integral(view, Projection::perspective, camera, variance, x);
      const double difference = std::abs(print->value(x) - exact);
      highest = std::max(highest, exact);
      sum += exact;
      error.most = std::max(error.most, difference);
      error.integral += difference;
    }
  }
  error.most /= highest;
  error.integral /= sum;
  return error;
}

Radii radii_of(const glm::dmat2& v) {
  const double half = 0.5 * (v[0][0] + v[1][1]), distance = std::hypot(0.5 * (v[0][0] - v[1][1]), v[0][1]);
  const double larger = half + distance;
  return {std::sqrt(larger), std::sqrt(std::max(0.0, glm::determinant(v) / larger))};
}

void reproduce_zwicker_figure9(Findings& findings, const Progress& progress) {
  findings.report().heading("Zwicker 2002, Fig. 9: the affine map against the exact one");
  Plot plot{.title = "a spherical kernel's footprint by the local affine map, against exact integration",
            .x_label = "standard deviation by distance from the eye",
            .y_label = "largest error, of the footprint's peak",
            .log_x = true,
            .log_y = true};
  std::string text = "zwicker-fig9  largest error by the kernel's spread (deviation by distance)\n    spread";
  auto json = nlohmann::ordered_json::array();
  std::vector<std::string> lines;
  constexpr double kAngles[] = {0, 15, 30, 45};
  for (const double degrees : kAngles) {
    Plot::Series series{fmt::format("{} degrees off the line of sight", degrees), {}, {}};
    text += fmt::format(" {:>9}", fmt::format("{} deg", degrees));
    std::size_t line = 0;
    for (double spread = 0.001; spread < 0.4; spread *= std::sqrt(10.0), ++line) {
      const AffineError error = affine_error(spread, degrees);
      series.x.push_back(spread);
      series.y.push_back(error.most);
      if (lines.size() <= line) lines.push_back(fmt::format("    {:6.4f}", spread));
      lines[line] += fmt::format(" {:>9.2e}", error.most);
      json.push_back(
          {{"degrees", degrees}, {"spread", spread}, {"most", error.most}, {"integral", error.integral}});
    }
    plot.series.push_back(std::move(series));
  }
  for (const std::string& line : lines) text += "\n" + line;
  findings.text(text + "\n");
  findings.plot("zwicker-fig9", plot);
  findings.result("zwicker_fig9", std::move(json));
  if (progress) progress(1);
}

void reproduce_zwicker_figure13(Findings& findings, const Progress& progress) {
  findings.report().heading("Zwicker 2002, Fig. 13: properties of the EWA volume resampling filter");
  std::string text = fmt::format("zwicker-fig13 {:>24} {:>14} {:>14}\n", "reconstruction", "EWA", "Swan");
  auto json = nlohmann::ordered_json::array();
  for (const FilterCase& filter : kCases) {
    const glm::dmat2 kernel = reconstruction(filter);
    const glm::dmat2 ewa = prefiltered(VolumePrefilter::ewa, kernel);
    const glm::dmat2 swan = prefiltered(VolumePrefilter::swan, kernel);
    const Radii radii[] = {radii_of(kernel), radii_of(ewa), radii_of(swan)};
    text += fmt::format("  {:<12} {:>12.2f} x {:.2f}px {:>7.2f} x {:.2f} {:>7.2f} x {:.2f}\n", filter.name,
                        radii[0].larger, radii[0].smaller, radii[1].larger, radii[1].smaller, radii[2].larger,
                        radii[2].smaller);
    Plot plot{.title = fmt::format("{}: {}", filter.name, filter.what),
              .x_label = "pixels",
              .y_label = "pixels",
              .same_scale = true};
    plot.series = {ellipse_of("reconstruction kernel", kernel),
                   ellipse_of("low-pass filter", glm::dmat2(1.0)), ellipse_of("EWA resampling filter", ewa),
                   ellipse_of("Swan: scaled uniformly", swan)};
    findings.plot(fmt::format("zwicker-fig13-{}", filter.name), plot);
    json.push_back({{"case", filter.name},
                    {"reconstruction", json_of(radii[0])},
                    {"ewa", json_of(radii[1])},
                    {"swan", json_of(radii[2])}});
  }
  findings.text(text);
  findings.result("zwicker_fig13", std::move(json));
  if (progress) progress(1);
}

}  // namespace splatscope::studies
