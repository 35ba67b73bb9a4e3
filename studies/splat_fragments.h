#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "model/render.h"
#include "studies/image_io.h"
#include "traces/scene.h"

// What the depth test of the machine did to the splats, fragment by fragment, beside what it should have done
// (Ren 2002, section 5.1).
namespace splatscope::studies {

// What the ray of each pixel's centre meets first, in double precision: the nearest of the surfels' opaque
// quads o +- s +- t, before they are moved.
struct VisibleSurface {
  int width = 0;
  int height = 0;
  std::vector<double> depth;          // camera z; INFINITY where the ray meets none
  std::vector<std::uint32_t> surfel;  // whose quad it is; 0 where there is none
};
VisibleSurface visible_surface(const traces::Scene& scene);

// Whether the pixel's ray and those of the eight pixels about it all meet the surface.
bool is_inside(const VisibleSurface& surface, int x, int y);

// Which surface a surfel belongs to, as a pixel sees it and whatever z_t is. To the visible one where it and
// the surfel that the ray meets first face the same way, and are no further apart than the splat and the quad
// reach together: two that overlap on one smooth surface always are; parallel sheets nearer than that no
// sampling tells apart. The other surfaces are behind the visible one, or in front of it where a splat
// reaches beyond its surface's quads.
enum class Layer : std::uint8_t { in_front, visible, behind };

// A fragment of the second pass inside its splat's cutoff: one that adds to the picture if it is kept.
struct SplatFragment {
  std::uint32_t surfel = 0;
  std::size_t pixel = 0;
  bool kept = false;  // by the machine
  // By the rule that z_t stands for: the splat's plane under the ray is at most z_t, along the ray, behind
  // what the ray meets first.
  bool kept_by_rule = false;
  Layer layer = Layer::visible;
  double weight = 0;  // rho_k at the pixel's centre
};

// Visits the fragments of `trace`, a recording of `scene` in one frame without hierarchy, which `rendered`
// drew with its work recorded, in the order of drawing. Only surfels with a filter (kernels::surfel_filter)
// are visited.
void for_each_fragment(const traces::Scene& scene, const Trace& trace, const Rendered& rendered,
                       const VisibleSurface& surface, const std::function<void(const SplatFragment&)>& visit);

struct FragmentCounts {
  std::size_t fragments = 0;
  std::size_t kept = 0;            // by the machine
  std::size_t wrongly_hidden = 0;  // the rule keeps them, the machine does not
  std::size_t wrongly_kept = 0;    // the other way round
  std::size_t of_surface = 0;      // of the visible surface
  std::size_t surface_hidden = 0;  // of these: hidden by the machine
  std::size_t leaking = 0;         // of surfaces behind it, kept by the machine
  std::size_t surface_pixels = 0;  // whose ray meets a surface; of these:
  std::size_t torn_pixels = 0;     // with less than half of what the visible surface's weights sum to
  std::size_t leaking_pixels = 0;  // with a fragment of a surface behind
  std::size_t inside_pixels = 0;   // is_inside; of these:
  std::size_t holes = 0;           // without any fragment
};
FragmentCounts count_fragments(const traces::Scene& scene, const Trace& trace, const Rendered& rendered,
                               const VisibleSurface& surface);

// The picture in grey, with the pixels marked on which fragments were wrongly hidden (red) or wrongly kept
// (blue; both: magenta).
Image wrong_pixels(const traces::Scene& scene, const Trace& trace, const Rendered& rendered,
                   const VisibleSurface& surface);

}  // namespace splatscope::studies
