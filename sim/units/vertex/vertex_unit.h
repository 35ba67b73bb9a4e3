#pragma once

#include <deque>
#include <vector>

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"
#include "sim/units/vertex/schedule.h"

namespace splatscope::sim {

// Vertices that a vertex unit takes together. `vertices` 0: no more of this draw.
struct VertexGroup {
  std::uint32_t number = 0;    // of the draw
  std::uint32_t vertices = 0;  // 1 to vertex.threads
};

// A vertex program made ready for the units: what it issues, and when.
struct VertexSchedule {
  std::vector<IssueSlot> slots;
  std::vector<GroupSchedule> groups;  // of 1, 2, ... vertices
  std::uint64_t instructions = 0;     // slots as Direct3D counts them
};

// One programmable vertex unit. Groups issue one after the other; while the results of one are still in the
// pipeline the next may issue.
class VertexUnit final : public DrawUnit {
 public:
  // `schedules`: of the programs of the trace, by DrawJob::vertex_program; outlives the unit.
  VertexUnit(std::string name, Completion& completion, const Machine::Vertex& spec,
             const std::vector<VertexSchedule>& schedules);
  void connect(Channel<VertexGroup>& in, Channel<VertexGroup>& out);

  Step advance(Cycle now) override;
  std::vector<Statistic> statistics() const override;
  std::string state() const override;

 private:
  static constexpr std::size_t kInPipeline = 2;  // groups whose results are not out yet

  struct Result {
    VertexGroup group;
    Cycle at;  // kNever: still issuing (referee)
  };

  std::uint64_t start(const DrawJob& job) override;
  bool retire(Cycle now);
  bool take(Cycle now);
  void issue_cycle();
  Step waiting(Cycle now) const;

  Machine::Vertex spec_;
  const std::vector<VertexSchedule>& schedules_;
  Channel<VertexGroup>* in_ = nullptr;
  Channel<VertexGroup>* out_ = nullptr;
  std::vector<IssueLogic> logics_;  // by program; the referee's
  IssueLogic* issuing_ = nullptr;   // the referee's, while a group issues
  Cycle issue_start_ = 0;
  Cycle next_start_ = 0;  // kNever: not known yet (referee)
  std::deque<Result> results_;
  std::uint64_t groups_ = 0, vertices_ = 0, slots_ = 0;
};

}  // namespace splatscope::sim
