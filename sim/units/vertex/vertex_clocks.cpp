#include "sim/units/vertex/vertex_clocks.h"

#include <algorithm>
#include <deque>
#include <optional>
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

// A unit whose input and output never keep it waiting: it issues, passes on the oldest vertex where that has
// ended, and takes one where it has room.
class SteadyUnit {
 public:
  SteadyUnit(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec)
      : logic_(slots, spec), most_(static_cast<std::size_t>(VertexUnit::most_vertices(spec))) {}

  std::optional<Issued> cycle() {
    if (results_.size() < most_ && logic_.next_free() == 0) results_.push_back(-1 - logic_.take());
    const auto issued = logic_.issue();
    if (issued && issued->is_last)
      *std::ranges::find(results_, -1 - issued->thread) = static_cast<int>(issued->result);
    if (!results_.empty() && results_.front() == 0) results_.pop_front();
    for (int& result : results_) result -= result > 0;
    return issued;
  }

  bool operator==(const SteadyUnit&) const = default;
  std::size_t hash() const {
    std::size_t hash = logic_.hash();
    for (const int result : results_) hash = 31 * hash + static_cast<std::size_t>(result);
    return hash;
  }

 private:
  IssueLogic logic_;
  std::size_t most_;
  std::deque<int> results_;  // of the vertices it holds: cycles until their result, or -1 - their thread
};

struct SteadyUnitHash {
  std::size_t operator()(const SteadyUnit& unit) const { return unit.hash(); }
};

}  // namespace

Throughput throughput(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec) {
  constexpr std::uint64_t kMostVertices =
      4096;  // if the unit has not come back to a state by then: on average
  SteadyUnit unit(slots, spec);
  std::unordered_map<SteadyUnit, Sums, SteadyUnitHash> ends;
  Sums sums;
  sums.waits.resize(slots.size());
  Cycle waited = 0;
  for (;;) {
    const auto issued = unit.cycle();
    ++sums.cycles;
    if (!issued) {
      ++waited;
      continue;
    }
    sums.waits[issued->slot] += waited;
    waited = 0;
    if (!issued->is_last) continue;
    ++sums.vertices;
    const auto [found, is_new] = ends.try_emplace(unit, sums);
    if (!is_new) return between(found->second, sums);
    if (sums.vertices == kMostVertices) return between({0, 0, std::vector<Cycle>(slots.size())}, sums);
  }
}

double clocks_per_vertex(const isa::Program& program, const Machine::Vertex& spec) {
  return throughput(issue_slots(program, spec), spec).clocks_per_vertex;
}

}  // namespace splatscope::sim
