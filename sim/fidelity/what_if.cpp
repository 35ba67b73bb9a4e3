#include "sim/fidelity/what_if.h"

#include "model/command/load_program.h"
#include "model/isa/analysis.h"
#include "model/vertex/vertex_fetch.h"
#include "sim/units/vertex/vertex_clocks.h"

namespace splatscope::sim {
namespace {

constexpr int kCorners = 4;

// A run that emits four corners: what they share, then the rest for each.
isa::Program emitting_corners(const isa::Program& program, std::uint32_t corner_inputs) {
  const std::vector<bool> by_corner = isa::dependent_on(program, corner_inputs);
  isa::Program out = program;
  out.instructions.clear();
  for (int pass = 0; pass <= kCorners; ++pass) {
    for (std::size_t i = 0; i < by_corner.size(); ++i) {
      if (by_corner[i] == (pass > 0)) out.instructions.push_back(program.instructions[i]);
    }
  }
  return out;
}

}  // namespace

bool reads_a_vertex_a_quad(const WhatIf& what_if) {
  return what_if.point_sprites || !what_if.corner_inputs.empty();
}

double clocks_of_vertex(const Trace& trace, const Draw& draw, const std::vector<IssueSlot>& slots,
                        const Machine::Vertex& spec, const WhatIf& what_if) {
  if (!reads_a_vertex_a_quad(what_if)) return throughput(slots, spec).clocks_per_vertex;
  if (what_if.point_sprites) return throughput(slots, spec).clocks_per_vertex / kCorners;
  const isa::Program program = load_program(trace.programs[draw.vertex_program]);
  const std::uint32_t inputs = what_if.corner_inputs[draw.vertex_program];
  return clocks_per_vertex(emitting_corners(program, inputs), spec) / kCorners;
}

double bytes_of_vertex(const Draw& draw, const WhatIf& what_if) {
  double bytes = draw.vertex_stride;
  if (what_if.corner_inputs.empty()) return bytes;
  for (const VertexAttribute& attribute : draw.attributes) {
    if ((what_if.corner_inputs[draw.vertex_program] >> attribute.input & 1u) != 0) {
      bytes -= vertex::size_of(attribute.format);
    }
  }
  return bytes;
}

}  // namespace splatscope::sim
