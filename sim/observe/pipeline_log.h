#pragma once

#include <iosfwd>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/command/commands.h"
#include "model/isa/program.h"
#include "sim/kernel/observer.h"
#include "sim/observe/log_window.h"
#include "sim/simulate.h"
#include "sim/units/vertex/vertex_unit.h"

namespace splatscope::sim {

// The instructions of the vertex units as a log that Konata opens (Kanata 0004): a row for each issue slot of
// each vertex, with the stages W (it waits: for its turn, for an operand, for the scalar unit) and X (from
// its issue until its results can be read), on the thread of its unit. Written as a stream.
class PipelineLog final : public Observer, public IssueWatcher {
 public:
  // Of the slots that issue in the window. `trace` is what will be simulated. `out` and `trace` outlive the
  // log.
  PipelineLog(std::ostream& out, const Trace& trace, const LogWindow& window);

  void begin(const SimulatedMachine& machine) override;
  void booked(const Unit&, std::uint32_t, Cycle, Cycle) override {}
  Cycle sample(Cycle) override { return kNever; }
  void end(const Result& result) override;

  void taken(const VertexUnit& unit, Cycle now, std::uint64_t vertex, VertexNumber number) override;
  void issued(const VertexUnit& unit, Cycle at, std::uint64_t vertex, const IssueSlot& slot,
              Cycle result) override;

  // What did not fit into `most_bytes` began here; kNever: everything did.
  Cycle cut_at() const { return cut_at_; }

 private:
  struct Row {
    std::uint32_t unit;
    std::string label;
    std::uint64_t id = 0;  // known once it is written
  };
  enum class Stage : std::uint8_t { waits, issues, ends };
  struct Event {
    std::shared_ptr<Row> row;
    Stage stage;
    bool is_first;  // of its row
  };
  // A vertex of a unit that has slots to issue.
  using VertexKey = std::pair<std::uint32_t, std::uint64_t>;
  struct OpenVertex {
    VertexNumber number;
    Cycle next;  // the first cycle in which its next slot can be
    std::size_t slots_left;
  };

  std::string label(const VertexUnit& unit, VertexNumber number, const IssueSlot& slot);
  const std::string& text(const VertexUnit& unit, const IssueSlot& slot);
  const isa::Program& program(const VertexUnit& unit);
  bool add_row(const VertexUnit& unit, Cycle at, const OpenVertex& open, const IssueSlot& slot, Cycle result);
  void write_before(Cycle cycle);
  void write(Cycle cycle, const Event& event);
  void stop();

  std::ostream& out_;
  const Trace& trace_;
  LogWindow window_;
  const SimulatedMachine* machine_ = nullptr;
  std::vector<VertexUnit*> units_;
  std::map<std::uint32_t, isa::Program> programs_;  // of the trace
  std::map<const IssueSlot*, std::string> texts_;   // of slots
  std::map<VertexKey, OpenVertex> open_;
  std::multimap<Cycle, Event> waiting_;  // of equal cycles in the order in which they came
  bool is_begun_ = false;
  Cycle at_ = 0;  // the last cycle written
  std::uint64_t rows_ = 0, retired_ = 0;
  std::uint64_t bytes_ = 0;  // at most, with what waits
  Cycle cut_at_ = kNever;
};

}  // namespace splatscope::sim
