#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/machine/machine.h"
#include "studies/reference_comparison.h"
#include "studies/study.h"

// How near pictures of models come to the double-precision reference, and what keeps them from it.
namespace splatscope::studies {

// A scene of a model, and the name that results give it.
struct ModelScene {
  std::string name;
  std::string toml;  // of its table `surfels`, without the count
};

// The real models of `folder` (./fetch-models) that are there, in the order of docs/models.md.
std::vector<ModelScene> real_models(const std::filesystem::path& folder);

// Where commands look for real models: `models` in the current folder.
inline constexpr std::string_view kModelsFolder = "models";

// One scene against its reference. Each step of the budget adds to what went before it, from the best that
// weights per surfel can give to the machine's picture.
struct QualityRow {
  std::string name;
  std::size_t surfels = 0;
  Comparison per_pixel;        // the machine's, normalised per pixel
  Comparison exact;            // weights of gamma.h's sums, drawn in double precision
  Comparison captured;         // weights captured on the machine, drawn in double precision
  Comparison float_frame;      // the same weights, drawn by the machine in floats: with_frame
  Comparison per_surfel;       // and with its own of 8 bits: the machine's picture
  Comparison same_weights;     // the machine's, against Eq. 5 in double precision with the captured weights
  double capture_seconds = 0;  // of the host
  std::size_t unseen = 0;      // surfels that no view of the capture saw
  Image reference, picture;    // picture: normalised per surfel
};
QualityRow quality_of(const std::string& name, traces::Scene scene, const Machine& machine,
                      const Progress& progress = {});

// Real models, and generators so that there is always something; at the defaults and with wider filters.
void study_quality(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
