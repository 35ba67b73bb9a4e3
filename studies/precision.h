#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kernels/reference/splat_sums.h"
#include "model/output/frame.h"
#include "studies/study.h"
#include "traces/scene.h"

// What each lossy step of the machine costs the picture, one switch a step.
namespace splatscope::studies {

// How far a frame is from the reference over the pixels that the surface covers.
struct Errors {
  double psnr = 0;          // dB
  double mean = 0;          // of a pixel's largest channel error, in 1/255
  double percentile99 = 0;  // the same
  double bias = 0;          // mean of frame less reference over channels, in 1/255
  double saturated =
      0;             // fraction of pixels with a channel at 1 or more where the reference is under 254/255
  double black = 0;  // fraction of pixels that are all 0 where the reference has a channel over 1/255
};
Errors errors_of(const Frame& frame, const kernels::SplatSums& reference);

// All that the switches turn.
struct Pipeline {
  NumberFormats numbers;
  int texel_bits = 8;
  int texture_size = 0;  // 0: by Eq. 16
  double cutoff = 1;
  bool circular = true;
  double gamma = 0;  // 0: the scene's
  traces::Algorithm algorithm = traces::Algorithm::ewa_per_pixel;
  bool corner_weights = true;  // where it normalises per surfel
};

// Every step wide or exact; and the GeForce4.
Pipeline ideal_pipeline();
Pipeline machine_pipeline();

// One setting of one switch.
struct Switch {
  std::string step;             // "alpha texture, bits"
  std::string level;            // "8"
  bool of_the_machine = false;  // as the GeForce4 has it
  bool in_full = false;         // compared with the filter cut off at c = 8, as it truncates it itself
  std::function<void(Pipeline&)> turn;
};
std::vector<Switch> precision_switches();

// A scene with its references.
struct PrecisionScene {
  std::string name;
  traces::Scene scene;
  kernels::SplatSums reference;       // of its own cutoff
  kernels::SplatSums full_reference;  // cut off at c = 8
};
PrecisionScene precision_plane(double tilt_degrees, int surfels_a_side, int frame_size);
// models/armadillo.off where it was fetched into the working folder, else a torus knot.
PrecisionScene precision_model(int surfels, int frame_size);

Frame draw(const traces::Scene& scene, const Pipeline& pipeline);

// A switch alone in the ideal pipeline, and in the machine with all the other steps as they are.
struct SwitchRow {
  Switch setting;
  std::vector<Errors> alone, in_machine;  // by scene
};
std::vector<SwitchRow> switch_rows(std::span<const Switch> switches, std::span<const PrecisionScene> scenes,
                                   const Progress& progress = {});

// White splats of the same weight, so many on each pixel, in a frame buffer: the sums of them are 0.73 where
// they are largest.
struct OverlapRow {
  std::string frame;                // "unorm8, truncate"
  double overlaps = 0;              // splats that touch a pixel, on average
  double bias = 0;                  // mean of frame less what it should be, in 1/255
  double saturated = 0, black = 0;  // fractions of pixels
};
std::vector<OverlapRow> overlap_rows(std::span<const double> overlaps, int frame_size);

// A green surface with waves of 1 by 16 spacings before a red one, 4 spacings apart, tilted by 45 degrees: by
// depth format and z_t.
struct DepthRow {
  std::string_view format;  // "z16"
  double offset = 0;        // z_t in spacings
  double lost = 0;          // of the green that should be there, on average over the pixels inside
  double holes = 0;         // fraction of these pixels with less than half of it
  double leaks = 0;         // fraction with more than 8/255 of red
};
std::vector<DepthRow> depth_rows(std::span<const double> offsets, int frame_size);

std::string header_of_switches(std::span<const PrecisionScene> scenes);
std::string line_of(const SwitchRow& row);  // without its end

void study_precision(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
