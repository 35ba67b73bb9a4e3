#pragma once

#include <functional>

#include "model/command/commands.h"
#include "model/number/formats.h"
#include "traces/hierarchy/block_choice.h"
#include "traces/scene.h"
#include "traces/weight_capture.h"

// What the application and the driver did in 2002: a scene becomes buffers, programs, state and draws.
namespace splatscope::traces {

// Host-side facts of a recording that a run reports beside its counters.
struct RecordCounts {
  std::size_t scene_surfels = 0;        // of the scene
  std::size_t surfels = 0;              // drawn, in the last frame
  BlockCounts blocks;                   // of the last frame
  std::size_t weights_captured = 0;     // surfels seen from at least one view of the capture
  std::size_t weights_at_edges = 0;     // of these: with a weight for each vertex
  std::size_t weights_by_default = 0;   // surfels seen from none: they get the median of the others
  std::size_t weights_outside_box = 0;  // surfels that the scene's box leaves unnormalised
};

struct Recording {
  Trace trace;
  RecordCounts counts;
};

// Records the frame of `scene`, or its frames where it is progressive: clear, visibility splatting, EWA or
// plain splatting, and for ewa-per-pixel the normalisation on the host. The other algorithms need per-surfel
// weights, captured first by rendering on the machine (`formats`), as section 7.2 describes, for each level
// of the hierarchy that is drawn. `progress` is told the fraction done.
Recording record(const Scene& scene, const NumberFormats& formats,
                 const std::function<void(double)>& progress = {});

// The same with weights captured before, one a surfel. Throws ModelError where the scene draws coarser
// levels.
Recording record(const Scene& scene, const CapturedWeights& captured);

}  // namespace splatscope::traces
