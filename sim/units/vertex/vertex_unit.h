#pragma once

#include <deque>
#include <vector>

#include "model/machine/machine.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"
#include "sim/units/vertex/issue_replay.h"

namespace splatscope::sim {

// A vertex on its way: its place among the shaded vertices of the draw.
using VertexNumber = std::uint32_t;
inline constexpr VertexNumber kEndOfDraw = ~VertexNumber{0};  // to a vertex unit: no more of this draw

class VertexUnit;

// Is told what vertex units issue, instruction by instruction, and changes nothing of it. `vertex`: how many
// the unit had taken before it.
class IssueWatcher {
 public:
  virtual ~IssueWatcher() = default;
  // In the order of the cycles, over all units. `number`: among the shaded vertices of the draw.
  virtual void taken(const VertexUnit& unit, Cycle now, std::uint64_t vertex, VertexNumber number) = 0;
  // In the order of the cycles for each unit, and before anything of a later cycle is known of the vertex;
  // told when the unit is next called, so other units may be ahead. `result`: the cycle in which the results
  // can be read.
  virtual void issued(const VertexUnit& unit, Cycle at, std::uint64_t vertex, const IssueSlot& slot,
                      Cycle result) = 0;
};

// One programmable vertex unit. Takes at most one vertex a cycle, whose first slot can issue in the next
// cycle, and passes the results on in the order in which it took the vertices, at most one a cycle. For each
// thread it has room for the result of one vertex that has ended.
class VertexUnit final : public DrawUnit {
 public:
  static constexpr int kInputVertices = 2;  // that wait before it: one can be taken in every cycle

  // `programs`: of the trace, by DrawJob::vertex_program; outlives the unit.
  VertexUnit(std::string name, Completion& completion, const Machine::Vertex& spec,
             const std::vector<std::vector<IssueSlot>>& programs);
  void connect(Channel<VertexNumber>& in, Channel<VertexNumber>& out);

  // Vertices that a unit holds at most, from taking to passing on.
  static int most_vertices(const Machine::Vertex& spec) { return 2 * spec.threads; }

  // `watcher` outlives the unit or is taken away again (null).
  void watch(IssueWatcher* watcher) { watcher_ = watcher; }
  const DrawJob& drawing() const { return job(); }

  Step advance(Cycle now) override;
  // The end of the draw: which unit gets how many vertices is found on the way.
  std::uint64_t items(const DrawJob& job) const override { return job.counts.shaded_vertices == 0 ? 0 : 1; }
  std::vector<Statistic> statistics(Cycle) const override;
  std::string state() const override;

 private:
  struct Vertex {
    VertexNumber number;
    Cycle result_at;  // kNever: not known before its last slot is issued
  };

  void start(const DrawJob& job) override;
  bool is_referee() const { return domain().scheduler() == Scheduler::referee; }
  const IssueLogic& logic() const { return is_referee() ? logics_[program_] : replays_[program_].logic(); }
  void issue_up_to(Cycle now);
  void show(const Issued& issued, Cycle at);
  void show_coming(Cycle cycles);
  void end(const Issued& last, Cycle at);
  bool retire(Cycle now);
  bool take(Cycle now);
  Cycle next_take() const;
  Step waiting(Cycle now);

  Machine::Vertex spec_;
  const std::vector<std::vector<IssueSlot>>& programs_;
  Channel<VertexNumber>* in_ = nullptr;
  Channel<VertexNumber>* out_ = nullptr;
  // By program: the logic issued cycle by cycle (referee), the logic replayed (skip-ahead).
  std::vector<IssueLogic> logics_;
  std::vector<IssueReplay> replays_;
  std::size_t program_ = 0;
  Cycle coming_ = 1;                       // the cycle that the logic goes on with
  Cycle reloaded_at_ = 0;                  // when all threads without a vertex are reloaded
  std::vector<std::uint64_t> of_threads_;  // the vertex that each thread took, counted as taken_
  std::deque<Vertex> vertices_;
  IssueWatcher* watcher_ = nullptr;
  std::uint64_t taken_ = 0, slots_ = 0;
};

}  // namespace splatscope::sim
