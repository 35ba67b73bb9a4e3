#pragma once

#include <vector>

#include "model/isa/program.h"
#include "model/machine/machine.h"
#include "sim/units/vertex/issue_slots.h"

namespace splatscope::sim {

// One vertex unit that never waits for a vertex nor for its output, once its issue repeats.
struct Throughput {
  double clocks_per_vertex = 0;
  std::vector<double> waits;  // by slot: clocks a vertex in which nothing issued and it was the next to issue
};

// `slots`: at least one.
Throughput throughput(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec);
double clocks_per_vertex(const isa::Program& program, const Machine::Vertex& spec);

}  // namespace splatscope::sim
