#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"

// EWA surface splatting in one pass, in double precision: Zwicker 2002, section 7.2. Where Ren 2002 draws a
// depth image first, here each contribution finds its surface in a z-buffer of one or more layers.
namespace splatscope::kernels {

struct LayeredSettings {
  bool prefilter = true;
  double cutoff = 2.0;           // c of Ren 2002, Eq. 14: the radial index ends at 2c, the 4 of section 7.1
  double same_surface = 0;       // camera z: contributions closer than this are of one surface; 0: none are
  int layers = 1;                // of a pixel, at least 1; the nearest are kept
  double whole_weight = 0;       // summed weight from which a layer covers its pixel; 0: any weight does
  bool cull_back_faces = false;  // surfels whose normal s x t points away from the eye are left out
  glm::dvec3 background{0.0};
};

// What became of the contributions, over all pixels: the threshold's outcomes.
struct LayerOutcomes {
  std::size_t added = 0;     // within the threshold of a layer
  std::size_t founded = 0;   // a layer of their own, in an empty place
  std::size_t replaced = 0;  // the same in the place of the furthest layer, where all are taken
  std::size_t dropped = 0;   // further than all layers

  bool operator==(const LayerOutcomes&) const = default;
};

struct LayeredPicture {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> pixels;  // r g b over the background; in w the opacity of the layers
  std::vector<double> weights;     // summed, of each pixel's nearest layer
  LayerOutcomes outcomes;
};

// Each surfel's screen-space filter of Eq. 35 with its conic by two additions a pixel, and 1/z of its tangent
// plane, which is linear on the screen, by one; the low-pass filter reaches beyond the surfel, z does not:
// planes seen edge-on would scatter. A contribution belongs to the layer whose z, that of the contribution
// which founded it, is nearest to its own, if it is closer than `same_surface`; else it founds a layer. A
// layer's colour and opacity are means by weight; its coverage is the summed weight over `whole_weight`, at
// most 1, which antialiases edges; layers are blended front to back, those joined that one surface has left.
// `opacities`: of each surfel, 0 to 1; empty: all 1. Several threads, the same bits for any number of them.
// Contributions count between the near and the far plane.
LayeredPicture layered_splatting(const View& view, std::span<const Surfel> surfels,
                                 std::span<const double> opacities, const LayeredSettings& settings);

}  // namespace splatscope::kernels
