#pragma once

#include <optional>
#include <string>

#include "studies/plot.h"
#include "studies/report.h"
#include "studies/sweep.h"

// What a sweep of one parameter or more found, for people and spreadsheets.
namespace splatscope::studies {

// As comma-separated values: a line for each frame of each machine with what was swept, cycles, half the
// width of their 95 % interval (empty but for `sampled`), milliseconds, frames a second, and, of a run of one
// frame, the unit that was busy for the largest share, and that share.
std::string csv_of(const Sweep& sweep);

// The rates of all frames together over the last parameter, a curve for each combination of the others.
// Nothing where its values are no numbers, or more than eight curves would lie in each other's way.
std::optional<Plot> plot_of(const Sweep& sweep);

// The sweep as a page: the curves, or why they could not be drawn, and a table of all machines.
Report report_of(const Sweep& sweep, const Machine& machine, Fidelity fidelity);

}  // namespace splatscope::studies
