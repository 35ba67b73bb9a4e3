#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "kernels/object_space_ewa/splat_accuracy.h"
#include "studies/run.h"
#include "traces/scene.h"

// What a shorter EWA program is worth: every one of kernels::ewa_programs() beside the paper's.
namespace splatscope::studies {

struct ProgramRow {
  std::string_view name;
  int slots = 0;
  bool live = false;                 // every instruction changes an output
  std::vector<Rate> rates;           // by machine, as kBothMachines
  kernels::SplatErrors ieee, nv20;   // against the double-precision filter
  double psnr_paper = 0;             // dB, of the float picture against the paper program's; infinite: equal
  double psnr_paper_one_weight = 0;  // the same where the corners of a quad share one weight
  double psnr_reference = 0;         // dB, of the first machine's picture against the reference
  sim::Result timing;                // on the first machine
};

// `scene` is drawn per surfel normalised by each of the named programs (the first is what
// the pictures are compared with), with the visibility program that it names itself. Accuracy over `surfels`
// random surfels.
std::vector<ProgramRow> program_rows(const traces::Scene& scene, std::span<const std::string_view> names,
                                     Fidelity fidelity, int surfels, const Progress& progress = {});

}  // namespace splatscope::studies
