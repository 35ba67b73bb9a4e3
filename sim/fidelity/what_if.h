#pragma once

#include <cstdint>
#include <vector>

#include "model/command/commands.h"
#include "model/machine/machine.h"
#include "sim/units/vertex/issue_slots.h"

namespace splatscope::sim {

// Hardware that no machine of 2002 had, for `study exploration`. No other fidelity knows it.
struct WhatIf {
  // A run of a vertex program emits the four corners of a quad from one vertex: instructions that depend on
  // these inputs (bit i: vi) run once a corner, the others once a quad; a vertex is read once, without these
  // inputs, and no index. By program of the trace; empty: a run a corner, as in 2002.
  std::vector<std::uint32_t> corner_inputs = {};
  // A quad is a point sprite: its program runs once, its vertex is read once without an index, and its two
  // triangles are assembled and set up as one primitive.
  bool point_sprites = false;
  // Pixels a clock that a unit at the end of the pipeline divides by their weight, in place of the host: it
  // reads and writes the frame in video memory. 0: there is none.
  int divided_pixels_per_clock = 0;
};

// Whether each quad, not each of its corners, is a vertex that is read.
bool reads_a_vertex_a_quad(const WhatIf& what_if);

// Clocks of a vertex unit for the program of a draw, and bytes that a vertex is read with: on average over
// the corners of a quad, and of one that is read.
double clocks_of_vertex(const Trace& trace, const Draw& draw, const std::vector<IssueSlot>& slots,
                        const Machine::Vertex& spec, const WhatIf& what_if);
double bytes_of_vertex(const Draw& draw, const WhatIf& what_if);

}  // namespace splatscope::sim
