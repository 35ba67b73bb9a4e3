#pragma once

#include <span>
#include <vector>

#include "model/machine/machine.h"
#include "studies/splat_fragments.h"
#include "studies/study.h"
#include "traces/scene.h"

// The depth image of visibility splatting (Ren 2002, section 5.1, Fig. 3), which must have no holes.
namespace splatscope::studies {

struct Figure3Scenes {
  traces::Scene even;    // a knot
  traces::Scene uneven;  // as many surfels of it at random, as a scanner might leave them
  traces::Scene dense;   // many more, in the same view: what is there
};
Figure3Scenes figure3_scenes();

// The first pass alone, with quads of `side` h.
Trace depth_trace(traces::Scene scene, double side);

// The depth image of one size of quads, against the surface itself.
struct DepthImage {
  double side = 0;                // of the opaque quads, units of each surfel's h; the paper's is 2
  Frame frame;                    // its depth buffer
  std::size_t inside_pixels = 0;  // of the surface: is_inside
  // Of these, the ones at which the depth image has a hole: it has nothing there, or something that is
  // further behind the surface than z_t and the scene's mean h, along the ray: another part of the model.
  std::vector<std::size_t> holes;
};

// Draws the depth image of `scene` on `machine` for each size. `surface` is what is there: the same model
// from many more surfels in the same view.
std::vector<DepthImage> depth_images(const traces::Scene& scene, std::span<const double> sides,
                                     const VisibleSurface& surface, const Machine& machine);

void reproduce_figure3(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
