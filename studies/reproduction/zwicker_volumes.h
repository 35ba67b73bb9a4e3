#pragma once

#include <string>
#include <vector>

#include "kernels/reference/volume/footprint.h"
#include "studies/image_io.h"
#include "studies/study.h"

// Zwicker 2002, Fig. 9 and 13 to 15: what the paper shows about volume splats. It prints neither cameras nor
// textures: both are stand-ins.
namespace splatscope::studies {

// Fig. 9: the affine map against the exact one.
struct AffineError {
  double spread = 0;    // standard deviation of a spherical kernel by its distance from the eye
  double most = 0;      // largest difference of the footprints, by the exact one's largest value
  double integral = 0;  // of |difference|, by that of the exact footprint
};
// `degrees` is the angle between the kernel's ray and the line of sight.
AffineError affine_error(double spread, double degrees);

// Fig. 13: radii of footprints, where the Gaussian falls to e^(-1/2), pixels.
struct Radii {
  double larger = 0, smaller = 0;
};
Radii radii_of(const glm::dmat2& variance);

// Fig. 14: a zebra texture of these voxels mapped to a square.
struct ZebraCase {
  std::string name;
  int columns = 0, rows = 0;
  kernels::View view;
};
std::vector<ZebraCase> zebra_cases(int texture, int frame);

// Pictures of both methods, and their PSNR against 64 samples a pixel of what they splat: filtered by a
// Gaussian of variance I, which is Eq. 12, and by a box.
struct ZebraRow {
  Image ewa, swan, reference;
  double psnr_ewa = 0, psnr_swan = 0;
  double psnr_ewa_box = 0, psnr_swan_box = 0;
};
ZebraRow compare_prefilters(const ZebraCase& zebra);

// Fig. 15: spherical kernels and flat ones, and their PSNR against the texture itself, 64 samples a pixel
// filtered by a Gaussian of variance I.
struct KernelRow {
  Image volume, surface, reference;
  double psnr_volume = 0, psnr_surface = 0;
};
KernelRow compare_kernels(int texture, const kernels::View& view);

void reproduce_zwicker_figure9(Findings& findings, const Progress& progress);
void reproduce_zwicker_figure13(Findings& findings, const Progress& progress);
void reproduce_zwicker_figure14(Findings& findings, const Progress& progress);
void reproduce_zwicker_figure15(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
