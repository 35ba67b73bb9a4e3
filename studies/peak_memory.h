#pragma once

// How much memory a part of a run takes, as the system (Linux) tells it.
namespace splatscope::studies {

// Gives back what the process has freed, and begins a new peak. False: the system does not let it.
bool restart_peak_memory();

// Of the process in memory at most since then; 0: the system does not tell.
double peak_megabytes();

}  // namespace splatscope::studies
