#include "sim/units/vertex/throughput.h"

#include <algorithm>
#include <unordered_map>

#include "sim/units/vertex/issue_logic.h"
#include "sim/units/vertex/vertex_unit.h"

namespace splatscope::sim {
namespace {

// Since the start.
struct Sums {
  Cycle cycles = 0;
  std::uint64_t vertices = 0;
  std::vector<Cycle> waits;
};

Throughput between(const Sums& from, const Sums& to) {
  const auto vertices = static_cast<double>(to.vertices - from.vertices);
  Throughput rates;
  rates.clocks_per_vertex = static_cast<double>(to.cycles - from.cycles) / vertices;
  for (std::size_t slot = 0; slot < to.waits.size(); ++slot)
    rates.waits.push_back(static_cast<double>(to.waits[slot] - from.waits[slot]) / vertices);
  return rates;
}

// That a vertex alone in its unit is there, from taking to passing on.
Cycle latency(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec) {
  IssueLogic logic(slots, spec);
  logic.take();
  for (Cycle cycles = 1;; ++cycles)
    if (const auto issued = logic.issue(); issued && issued->is_last) return cycles + issued->result;
}

// By its issue alone, however many vertices it holds.
Throughput issue_rates(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec) {
  constexpr std::uint64_t kMostVertices =
      4096;  // if the issue has not come back to a state by then: on average
  IssueLogic logic(slots, spec);
  std::unordered_map<IssueLogic, Sums, IssueLogicHash> ends;
  Sums sums;
  sums.waits.resize(slots.size());
  Cycle waited = 0;
  for (;;) {
    if (logic.next_free() == 0) logic.take();
    const auto issued = logic.issue();
    ++sums.cycles;
    if (!issued) {
      ++waited;
      continue;
    }
    sums.waits[issued->slot] += waited;
    waited = 0;
    if (!issued->is_last) continue;
    ++sums.vertices;
    const auto [found, is_new] = ends.try_emplace(logic, sums);
    if (!is_new) return between(found->second, sums);
    if (sums.vertices == kMostVertices) return between({0, 0, std::vector<Cycle>(slots.size())}, sums);
  }
}

}  // namespace

Throughput throughput(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec) {
  Throughput rates = issue_rates(slots, spec);
  rates.clocks_per_vertex = std::max(
      rates.clocks_per_vertex, static_cast<double>(latency(slots, spec)) / VertexUnit::most_vertices(spec));
  return rates;
}

double clocks_per_vertex(const isa::Program& program, const Machine::Vertex& spec) {
  return throughput(issue_slots(program, spec), spec).clocks_per_vertex;
}

}  // namespace splatscope::sim
