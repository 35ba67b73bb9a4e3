#pragma once

#include <cstddef>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "kernels/reference/fast_splat.h"
#include "kernels/reference/surfel_filter.h"
#include "kernels/view.h"

// EWA surface splatting on the host at speed: what a graphics card of 2002 had to beat.
namespace splatscope::kernels {

struct FastSettings {
  bool prefilter = true;
  double cutoff = 1.0;           // c of Ren 2002, Eq. 14: a splat ends on the ellipse y.y = 2c
  double depth_offset = 0;       // z_t of section 5.1, camera-space units, >= 0
  bool cull_back_faces = false;  // surfels whose normal s x t points away from the eye are left out
};

struct FastPicture {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> pixels;  // normalised r g b, 0 where nothing counts; in w the summed weights
  // Surfels that face away, are before the near plane or outside of the picture, or have no finite filter.
  std::size_t left_out = 0;
};

// The picture of screen_space_ewa with the affine map and the circular cutoff, in single precision: SIMD over
// surfels while they are set up and over pixels while they are drawn; the conic by two additions a pixel and
// the Gaussian from a table (Zwicker 2002, section 7.1), the depth of the tangent plane by one (7.2). The
// same bits for any number of threads and on every SIMD target. Keeps its buffers between frames: one draw at
// a time.
class FastSplatting {
 public:
  explicit FastSplatting(std::span<const Surfel> surfels);

  FastPicture draw(const View& view, const FastSettings& settings);

 private:
  std::size_t surfels_;
  FastSurfels model_;
  std::vector<FastSplat> splats_;
};

}  // namespace splatscope::kernels
