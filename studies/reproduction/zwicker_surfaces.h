#pragma once

#include <string>
#include <vector>

#include "kernels/reference/layered_splatting.h"
#include "studies/reproduction/surface_models.h"
#include "studies/study.h"

// EWA surface splatting in software: Zwicker 2002, Fig. 17 and Table I.
namespace splatscope::studies {

// A model by the layered renderer, with antialiased edges on a dark background. What weight covers a pixel is
// taken from the picture: nine tenths of the median over the pixels' nearest layers.
kernels::LayeredPicture draw_layered(const SurfaceModel& model, int layers);

struct SurfaceRow {
  std::string model, stand_in;
  std::size_t points = 0;
  int size = 0;                // pixels: width and height
  double published_fps = 0;    // on a 1.1 GHz Athlon
  double layered_seconds = 0;  // double precision, eight layers, this host
  double single_seconds = 0;   // fast_splatting: opaque, single precision, SIMD, this host
};

// Table I with `share` of the points: the median of `repeats` frames each.
std::vector<SurfaceRow> surface_rows(double share, int repeats, const Progress& progress = {});

void reproduce_zwicker_figure17(Findings& findings, const Progress& progress);
void reproduce_zwicker_table1(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
