#pragma once

#include <nlohmann/json.hpp>

#include "studies/result_files.h"
#include "studies/run.h"

// What a run of a scene or a trace leaves in its folder.
namespace splatscope::studies {

// The figures of a time: `frames`, `units` and `units_left_out`, as the documentation of result files lists
// them.
nlohmann::ordered_json timing_json(const sim::Result& timing);

// The parameters of a machine that the command line set: {"vertex.units": "4", "numbers.frame": "half"}.
nlohmann::ordered_json settings_json(const Machine& machine);
nlohmann::ordered_json programs_json(const Trace& trace);  // names and instruction slots
// A value of machine::describe as --set and --sweep take it: a word without the quotes that TOML wants.
std::string unquoted(std::string_view value);

// The figures of a run, as the documentation of result files lists them.
nlohmann::ordered_json results_of(const Input& input, const Machine& machine, Fidelity fidelity,
                                  const FrameRun& run);

// Writes the frames of `trace` before its last one as frame-000.png, frame-001.png, ... among `files`, which
// outlive it.
OnFrame earlier_frames_writer(const Trace& trace, const ResultFiles& files);

// Writes frame.exr, frame.png and depth.exr of the last frame, results.json and report.html; where the run
// has a reference also reference.exr, reference.png and difference.png, and into the results how far the last
// frame is from it; its heat maps as NAME.exr. Commits `files`, and returns their names.
std::vector<std::string> write_run(const Input& input, const Machine& machine, Fidelity fidelity,
                                   const FrameRun& run, ResultFiles& files);

}  // namespace splatscope::studies
