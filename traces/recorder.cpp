#include "traces/recorder.h"

#include "traces/splat_trace.h"

namespace splatscope::traces {

Recording record(const Scene& scene, const CapturedWeights& captured) {
  const Splatting& settings = scene.splatting;
  const bool per_pixel = settings.algorithm == Algorithm::ewa_per_pixel;
  Recording out;
  out.counts.surfels = scene.surfels.size();
  out.trace = splat_trace(scene.surfels, view_of(scene.camera, scene.frame), settings,
                          {.weights = captured.weights,
                           .prefilter = settings.algorithm != Algorithm::no_ewa,
                           .sum_weights = per_pixel});
  if (per_pixel) {
    out.trace.commands.emplace_back(NormalizeOnHost{});
  } else {
    out.counts.weights_captured = captured.captured;
    out.counts.weights_at_edges = captured.at_edges;
    out.counts.weights_by_default = captured.unseen;
    out.counts.weights_outside_box = captured.outside_box;
  }
  return out;
}

Recording record(const Scene& scene, const NumberFormats& formats,
                 const std::function<void(double)>& progress) {
  if (scene.splatting.algorithm != Algorithm::ewa_per_pixel) {
    return record(scene, capture_weights(scene.surfels, scene.splatting, scene.capture, formats, progress));
  }
  // The sum of the weights must not saturate: gamma keeps it under 1, and the division takes it out again.
  CapturedWeights equal;
  equal.weights.resize(scene.surfels.size(), equal_weights(scene.splatting.gamma));
  return record(scene, equal);
}

}  // namespace splatscope::traces
