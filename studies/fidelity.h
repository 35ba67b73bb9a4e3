#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/run.h"
#include "traces/scene.h"

namespace splatscope::studies {

// One fidelity on one frame and machine, against the referee on the same.
struct FidelityRow {
  std::string scene;
  int resolution = 0;  // pixels: width and height
  std::string machine;
  Fidelity fidelity = Fidelity::functional;
  double host_seconds = 0;       // function and timing; of a frame of several, on average
  sim::Cycle cycles = 0;         // 0: functional
  double cycles_plus_minus = 0;  // of fidelity sampled
  double error = 0;              // of the cycles, relative
  struct UnitError {
    std::string unit;
    double error = 0;  // of its utilisation (busy cycles of all cycles) over all frames of the trace
  };
  std::vector<UnitError> units;
  double peak_megabytes = 0;  // resident memory of the process at most; 0: the system does not tell
  struct Seed {
    double cycles = 0;
    double plus_minus = 0;
    double error = 0;
    bool covers() const;  // whether the referee's cycles are in the interval
  };
  // Of fidelity sampled: by --seed 0, 1, ..., kSampleSeeds - 1, without those but 0 by which the frame was
  // simulated whole.
  std::vector<Seed> seeds;
};
// From the fastest to the one that the others are measured by.
inline constexpr Fidelity kFidelityLadder[] = {Fidelity::functional, Fidelity::throughput, Fidelity::sampled,
                                               Fidelity::cycle, Fidelity::referee};
inline constexpr std::uint64_t kSampleSeeds = 10;
inline constexpr int kFidelityRepetitions = 3;  // of the study

// A frame as each machine draws it, or several.
struct FidelityFrame {
  std::string scene;
  int resolution = 0;  // pixels: width and height
  std::function<Trace(const Machine&)> record;
};
FidelityFrame frame_of(traces::Scene scene);

// Those of the paper's figures (Ren 2002) that draw other scenes than the tables: one a scene, as the paper
// says that it should be drawn.
std::vector<FidelityFrame> figure_frames();

// All fidelities on one frame, or on each of several, and both machines. The host's seconds are the least of
// `repetitions` runs, but for the referee, which runs once.
std::vector<FidelityRow> fidelity_rows(const FidelityFrame& frame, int repetitions,
                                       const Progress& progress = {});

struct FidelityGroup {
  std::string_view name;  // "Table 1"
  std::vector<FidelityRow> rows;
};
// What is said of the frames of a group: a line for each fidelity.
std::string fidelity_text(const FidelityGroup& group);
// Tables, a plot and figures.
void add_fidelity_report(Findings& findings, std::span<const FidelityGroup> groups);

// The study: the frames of Table 1, of Table 2, of the figures and of progressive rendering.
void study_fidelity(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
