#include "traces/recorder.h"

#include "traces/splat_trace.h"
#include "traces/weight_capture.h"

namespace splatscope::traces {

Recording record(const Scene& scene, const NumberFormats& formats,
                 const std::function<void(double)>& progress) {
  Recording out;
  out.counts.surfels = scene.surfels.size();
  const Splatting& settings = scene.splatting;

  CapturedWeights captured;
  const bool per_pixel = settings.algorithm == Algorithm::ewa_per_pixel;
  if (per_pixel) {
    // The sum of the weights must not saturate: gamma keeps it under 1, and the division takes it out again.
    captured.weights.assign(scene.surfels.size(), static_cast<float>(settings.gamma));
  } else {
    captured = capture_weights(scene, formats, progress);
    out.counts.weights_captured = captured.captured;
    out.counts.weights_by_default = scene.surfels.size() - captured.captured;
  }
  const bool prefilter = settings.algorithm != Algorithm::no_ewa;
  out.trace = splat_trace(scene.surfels, view_of(scene.camera, scene.frame), settings,
                          {.weights = captured.weights, .prefilter = prefilter, .sum_weights = per_pixel});
  if (per_pixel) out.trace.commands.emplace_back(NormalizeOnHost{});
  if (progress) progress(1);
  return out;
}

}  // namespace splatscope::traces
