#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "kernels/reference/screen_space.h"
#include "model/output/frame.h"
#include "studies/image_io.h"
#include "traces/scene.h"
#include "traces/volumes/volume_scene.h"

// A simulated picture against the double-precision reference of the same scene.
namespace splatscope::studies {

// The scene's surfels as the references take them: s_k is gamma for each.
std::vector<kernels::Surfel> reference_surfels(const traces::Scene& scene);

// The filter of Eq. 8 as the scene cuts it off, with the prefilter whatever its algorithm.
kernels::ReferenceSettings filter_of(const traces::Scene& scene);

// The reference of a scene that shows a single surface, by Eq. 8: every surfel counts, none hides another.
kernels::SplatSums single_surface_reference(const traces::Scene& scene);

// "affine" or "perspective". Throws UserError (file "--reference") for another name.
kernels::ScreenMap screen_map_by_name(std::string_view name);

// The reference of any scene: visibility by the model of Ren 2002, section 5.1, with the scene's z_t, and the
// EWA prefilter whatever its algorithm.
kernels::ScreenSpacePicture screen_space_reference(const traces::Scene& scene,
                                                   kernels::ScreenMap map = kernels::ScreenMap::affine);
// The same of surfels with other weights than the scene's.
kernels::ScreenSpacePicture screen_space_reference(const traces::Scene& scene,
                                                   std::span<const kernels::Surfel> surfels,
                                                   kernels::ScreenMap map = kernels::ScreenMap::affine);

// The reference of a volume: in double precision, with the same sheets, over its background. It has no depth:
// every pixel is one at an edge. The weight is 1 where the volume covers a pixel by half a step of 8 bits.
kernels::ScreenSpacePicture volume_reference(const traces::VolumeScene& scene);

// Peak signal-to-noise ratio in dB of r, g and b over the pixels that the surface covers: those where the
// summed weights are at least half of what they are in its inside. Splats reach further, but there is no
// surface there, and only the normalisation per pixel makes it look as if there were. Infinite where the
// frame is exact, NaN where the surface covers nothing.
double psnr(const Frame& frame, const kernels::SplatSums& reference);

// How a frame differs from the reference, over the pixels that the surface covers as for psnr.
struct Comparison {
  std::size_t surface_pixels = 0;
  double psnr = 0;         // dB
  double worst = 0;        // largest difference of a channel, in 1/255
  std::size_t over_8 = 0;  // pixels with a channel that is more than 8/255 off
  // The same away from edges: no pixel within four, as far as a splat's filter reaches, has nothing beside it
  // or something more than 2 z_t nearer or further. At an edge a part of every filter lies off the surface.
  // Normalised per pixel that part is divided out; normalised per surfel the surface fades over its last
  // pixels, as a prefiltered edge does: there the two are different pictures, in whatever precision.
  std::size_t pixels_off_edges = 0;
  double psnr_off_edges = 0;  // dB
  // Pixels inside the silhouette (their rays and those of the eight pixels about them meet an opaque quad of
  // the reference), and of these the ones that the frame left black where the reference is not as good as
  // black: holes, which no splat covers, and pixels that splats cover whose colours all rounded to nothing,
  // whether their weights did or not.
  std::size_t inside_pixels = 0;
  std::size_t holes = 0;
  std::size_t rounded_to_black = 0;
};
// Whether the rays of a pixel of a depth image and of the eight about it all meet something: finite depths.
// Not where one of them lies beyond the border.
bool is_inside(std::span<const double> depth, int width, int height, int x, int y);

// `unrounded` gives the frame as a machine that computes colours in floats leaves it, and is asked only where
// there may be holes. Without it every pixel left black and without weight is a hole.
Comparison compare(const Frame& frame, const kernels::ScreenSpacePicture& reference,
                   const std::function<Frame()>& unrounded = {});

// For results.json. A figure that no file can hold, an infinite PSNR, is null there.
nlohmann::ordered_json json_of(const Comparison& comparison);

// "PSNR 40.1 dB over 1234 pixels", or "no pixel is covered".
std::string describe_psnr(const Comparison& comparison);

// Of the summed weights where there are any; 0 where there are none.
double median_weight(const kernels::SplatSums& reference);

// The reference as a picture, normalised per pixel.
Image picture_of(const kernels::SplatSums& reference);

// Mid-grey where the frame agrees with the reference; 16 times their difference about it.
Image difference_picture(const Frame& frame, const kernels::SplatSums& reference);

}  // namespace splatscope::studies
