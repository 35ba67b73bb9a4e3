#pragma once

#include <glm/vec3.hpp>

#include "kernels/reference/volume/fast_volume.h"
#include "kernels/view.h"
#include "studies/image_io.h"

// Pictures of volumes, and the finer ones that they are compared with.
namespace splatscope::studies {

// Over an opaque background.
Image picture_of(const kernels::FastVolumePicture& picture, const glm::dvec3& background);

inline constexpr int kFiner = 8;  // samples along an edge of a pixel: 64 a pixel

// The view with kFiner x kFiner pixels in the place of each.
kernels::View finer(const kernels::View& view);

enum class LowPass {
  gaussian,  // of variance I: the low-pass of the EWA filter
  box        // the mean of a pixel's samples
};
// From a picture of the finer view to one of the view.
Image low_passed(const Image& fine, LowPass filter);

// dB over the pixels at least `margin` pixels from the picture's edge.
double psnr_inside(const Image& a, const Image& b, int margin);

// The zebra texture itself on the square [-1, 1]^2 of the plane z = height, point-sampled under the pixels'
// rays; `background` elsewhere.
Image zebra_picture(const kernels::View& view, double height, double period, const glm::dvec3& background);

}  // namespace splatscope::studies
