#include "studies/reference_comparison.h"

#include <algorithm>
#include <cmath>

#include "traces/splat_trace.h"

namespace splatscope::studies {
namespace {

// Of the summed weights where there are any.
double median_weight(const kernels::ReferencePicture& reference) {
  std::vector<double> weights;
  for (const glm::dvec4& sum : reference.sums) {
    if (sum.w > 0) weights.push_back(sum.w);
  }
  if (weights.empty()) return 0;
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2);
  std::ranges::nth_element(weights, middle);
  return *middle;
}

}  // namespace

kernels::ReferencePicture scene_reference(const traces::Scene& scene, const Leave& leave) {
  std::vector<kernels::Surfel> surfels;
  surfels.reserve(scene.surfels.size());
  for (const traces::Surfel& surfel : scene.surfels) {
    const auto [s, t] = traces::tangents(surfel);
    surfels.push_back({glm::dvec3(surfel.position), s, t, scene.splatting.sigma, scene.splatting.gamma,
                       glm::dvec3(surfel.color)});
  }
  const kernels::ReferenceSettings settings{
      .prefilter = true,
      .cutoff = scene.splatting.cutoff,
      .shape = scene.splatting.circular_cutoff ? kernels::CutoffShape::circle : kernels::CutoffShape::square,
      .cutoff_tolerance = leave.cutoff_tolerance,
      .edge_tolerance = leave.edge_tolerance,
      .texture_length = leave.eight_bit_texels ? kernels::optimal_length(scene.splatting.cutoff) : 0};
  return kernels::ewa_reference(traces::view_of(scene.camera, scene.frame), surfels, settings);
}

double psnr(const Frame& frame, const kernels::ReferencePicture& reference) {
  const double half = 0.5 * median_weight(reference);
  double squares = 0;
  std::size_t samples = 0;
  for (std::size_t pixel = 0; pixel < reference.coverage.size(); ++pixel) {
    if (reference.sums[pixel].w < half) continue;
    const Vec4 color = frame.color(pixel);
    for (int c = 0; c < 3; ++c, ++samples) {
      const double difference =
          std::clamp(double{color[static_cast<std::size_t>(c)]}, 0.0, 1.0) - reference.normalized[pixel][c];
      squares += difference * difference;
    }
  }
  return -10 * std::log10(squares / static_cast<double>(samples));
}

SurfaceAgreement agreement(const Frame& frame, const kernels::ReferencePicture& reference) {
  const double half = 0.5 * median_weight(reference);
  SurfaceAgreement both;
  for (std::size_t pixel = 0; pixel < reference.coverage.size(); ++pixel) {
    if (reference.coverage[pixel] != kernels::Coverage::certain) continue;
    Agreement& out = reference.sums[pixel].w < half ? both.fringe : both.surface;
    ++out.pixels;
    out.with_ties += reference.lowest[pixel] != reference.highest[pixel];
    const Vec4 color = frame.color(pixel);
    double distance = 0;  // 1/255
    for (int c = 0; c < 3; ++c) {
      const double value = color[static_cast<std::size_t>(c)];
      distance = std::max({distance, 255 * (reference.lowest[pixel][c] - value),
                           255 * (value - reference.highest[pixel][c])});
    }
    out.outside += distance > 0.5;
    out.worst = std::max(out.worst, distance);
  }
  return both;
}

}  // namespace splatscope::studies
