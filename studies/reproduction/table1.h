#pragma once

#include <string>
#include <vector>

#include "studies/run.h"
#include "studies/study.h"

// Table 1 of Ren, Pfister, Zwicker, Object Space EWA Surface Splatting (2002), on the simulated machines.
namespace splatscope::studies {

struct Table1Row {
  std::string algorithm;  // "no-ewa", "ewa-per-pixel", "ewa-per-surfel"
  std::string machine;
  int visibility_slots = 0;  // counted from the programs of the trace that ran
  int splat_slots = 0;
  double published_fps = 0;
  Rate simulated;
  std::string fitted_by;  // the parameter of the machine that was fitted to this very figure, or empty
  double cycles_per_host_second = 0;
  double psnr = 0;     // against the double-precision EWA reference, dB
  sim::Result timing;  // all of it

  bool fitted() const { return !fitted_by.empty(); }
  double error() const { return simulated.fps / published_fps - 1; }
};

// Runs the six frames at cycle fidelity: algorithm by algorithm, the Radeon first, as printed.
std::vector<Table1Row> table1_rows(const Progress& progress = {});

void reproduce_table1(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
