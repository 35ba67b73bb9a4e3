#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/simulate.h"
#include "studies/study.h"

// Table 1 of Ren, Pfister, Zwicker, Object Space EWA Surface Splatting (2002), on the simulated machines.
namespace splatscope::studies {

struct Table1Row {
  std::string algorithm;  // "no-ewa", "ewa-per-pixel", "ewa-per-surfel"
  std::string machine;
  int visibility_slots = 0;  // counted from the programs of the trace that ran
  int splat_slots = 0;
  double published_fps = 0;
  double simulated_fps = 0;
  bool fitted = false;     // a parameter of the machine was fitted to this very figure
  std::string fitted_by;   // that parameter
  std::string bottleneck;  // the unit that was busy for the largest share of the frame
  double bottleneck_share = 0;
  double cycles_per_host_second = 0;
  double psnr = 0;     // against the double-precision EWA reference, dB
  sim::Result timing;  // all of it

  double error() const { return simulated_fps / published_fps - 1; }
};

// Runs the six frames at cycle fidelity: algorithm by algorithm, the Radeon first, as printed.
std::vector<Table1Row> table1_rows(const Progress& progress = {});

void reproduce_table1(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
