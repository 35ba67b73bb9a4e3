#pragma once

#include <string_view>
#include <vector>

#include "studies/run.h"
#include "studies/study.h"

// Object space on the machine against screen space in software (Ren 2002, section 8): splats a second, and
// how they change with the number of pixels.
namespace splatscope::studies {

struct SoftwareRow {
  std::string_view renderer;     // "software, single", "software, double", or a machine
  int resolution = 0;            // pixels: width and height
  double seconds = 0;            // a frame: of this host, or simulated
  double splats_per_second = 0;  // points of the model over `seconds`, as the paper counts
};

// `scene` at each resolution: the two software renderers on this host, the median of `repeats` frames, and
// both machines at `fidelity`, which gives times. Weights are captured from one view only: they say nothing
// of the time.
std::vector<SoftwareRow> software_rows(traces::Scene scene, std::span<const int> resolutions, int repeats,
                                       Fidelity fidelity, const Progress& progress = {});

// How the time of a frame grows with the pixels: the slope of log(seconds) over log(pixels), by least squares
// over the rows of `renderer`, of which there are two at least.
double growth(std::span<const SoftwareRow> rows, std::string_view renderer);

void study_software(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
