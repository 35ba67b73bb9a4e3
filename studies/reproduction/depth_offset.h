#pragma once

#include "model/machine/machine.h"
#include "studies/run.h"
#include "studies/splat_fragments.h"
#include "traces/weight_capture.h"

// One scene with the depth offset of either scheme (Ren 2002, section 5.1): what Fig. 4 and Fig. 5 compare.
namespace splatscope::studies {

traces::Scene figure4_scene();
traces::Scene figure5_scene();

// `scene` with z_t of `scheme`, all surfels in its order.
traces::Scene with_offset(traces::Scene scene, traces::DepthOffsetScheme scheme, double z_t);

struct OffsetRun {
  Trace trace;
  Rendered rendered;  // with its work
  FragmentCounts counts;
};

// Draws `scene` with z_t of `scheme` on `machine`. `surface` is the scene's.
OffsetRun run_with_offset(const traces::Scene& scene, traces::DepthOffsetScheme scheme, double z_t,
                          const traces::CapturedWeights& weights, const Machine& machine,
                          const VisibleSurface& surface);

// Both schemes with the scene's z_t, side by side: pictures, where fragments are wrongly hidden or kept, and
// how many. `name` ("fig4") begins the names of files and keys.
void compare_schemes(const std::string& name, const traces::Scene& scene,
                     const traces::CapturedWeights& weights, const Machine& machine,
                     const VisibleSurface& surface, Findings& findings);

// The same with z_t from too small to too large, along viewing rays.
struct OffsetRow {
  double spacings = 0;  // z_t in units of the scene's, the average spacing
  FragmentCounts counts;
};
std::vector<OffsetRow> sweep_offset(const traces::Scene& scene, std::span<const double> spacings,
                                    const traces::CapturedWeights& weights, const Machine& machine,
                                    const VisibleSurface& surface, const Progress& progress = {});

}  // namespace splatscope::studies
