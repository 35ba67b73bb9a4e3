#pragma once

#include <cstddef>

#include "kernels/reference/ewa_reference.h"
#include "model/output/frame.h"
#include "traces/scene.h"

// A simulated picture against the double-precision reference of the same scene.
namespace splatscope::studies {

// What a picture is given leave for, beside half a step of 8 bits: see kernels::ReferenceSettings.
struct Leave {
  double cutoff_tolerance = 0;    // y: where the circular cutoff is decided on texels
  double edge_tolerance = 0;      // y: where edges move to the rasteriser's grid
  bool eight_bit_texels = false;  // the value of a splat is that of an 8-bit texel, not the Gaussian's
};

// The reference of a scene: with the EWA prefilter whatever its algorithm, normalised per pixel.
kernels::ReferencePicture scene_reference(const traces::Scene& scene, const Leave& leave = {});

// Peak signal-to-noise ratio in dB of r, g and b over the pixels that the surface covers: those where the
// summed weights are at least half of what they are in its inside. Splats reach further, but there is no
// surface there, and only the normalisation per pixel makes it look as if there were.
double psnr(const Frame& frame, const kernels::ReferencePicture& reference);

struct Agreement {
  std::size_t pixels = 0;     // with splats that certainly count
  std::size_t with_ties = 0;  // of these: at least one splat may count or not
  std::size_t outside = 0;    // of these: further than 0.5/255 from the reference's bounds
  double worst = 0;           // distance from the bounds, in 1/255
};

// How far the picture is from what the reference allows, given either way for splats whose edge passes within
// the reference's tolerance of a pixel's centre: on the surface (as for psnr), and on the fringe of splats
// beyond it, where so few overlap that the rounding of the 8-bit texture shows.
struct SurfaceAgreement {
  Agreement surface, fringe;
};
SurfaceAgreement agreement(const Frame& frame, const kernels::ReferencePicture& reference);

}  // namespace splatscope::studies
