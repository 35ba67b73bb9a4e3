#include "sim/observe/pipeline_log.h"

#include <algorithm>
#include <ostream>

#include "model/command/load_program.h"
#include "model/isa/tokens.h"
#include "sim/machine.h"

namespace splatscope::sim {
namespace {

// Of a row beside its label: its eight lines, and lines that pass cycles.
constexpr std::uint64_t kBytesBesideLabel = 144;

}  // namespace

PipelineLog::PipelineLog(std::ostream& out, const Trace& trace, const LogWindow& window)
    : out_(out), trace_(trace), window_(window) {}

void PipelineLog::begin(const SimulatedMachine& machine) {
  machine_ = &machine;
  out_ << "Kanata\t0004\n";
  for (const auto& unit : machine.units) {
    if (auto* vertex = dynamic_cast<VertexUnit*>(unit.get())) {
      vertex->watch(this);
      units_.push_back(vertex);
    }
  }
}

const isa::Program& PipelineLog::program(const VertexUnit& unit) {
  const std::uint32_t number = unit.drawing().draw->vertex_program;
  const auto known = programs_.find(number);
  if (known != programs_.end()) return known->second;
  return programs_.emplace(number, load_program(trace_.programs[number])).first->second;
}

const std::string& PipelineLog::text(const VertexUnit& unit, const IssueSlot& slot) {
  const auto [found, is_new] = texts_.try_emplace(&slot);
  if (!is_new) return found->second;
  const isa::Program& from = program(unit);
  for (const int place : slot.instructions) {
    if (place < 0) continue;
    if (!found->second.empty()) found->second += " + ";
    found->second += isa::disassemble(from, from.instructions[static_cast<std::size_t>(place)]);
  }
  return found->second;
}

std::string PipelineLog::label(const VertexUnit& unit, VertexNumber number, const IssueSlot& slot) {
  return unit.name() + " command " + std::to_string(unit.drawing().command) + " vertex " +
         std::to_string(number) + ": " + text(unit, slot);
}

void PipelineLog::taken(const VertexUnit& unit, Cycle now, std::uint64_t vertex, VertexNumber number) {
  if (now > window_.last && open_.empty()) return stop();
  if (now <= window_.last) {
    const std::size_t slots = machine_->vertex_programs[unit.drawing().vertex_program].size();
    open_[{unit.number(), vertex}] = {number, now + 1, slots};
  }
  // Nothing that is still to come begins before this: of a new vertex the next cycle, of an open one its next
  // slot's first.
  Cycle next = now + 1;
  for (const auto& [key, open] : open_) next = std::min(next, open.next);
  write_before(next);
}

void PipelineLog::issued(const VertexUnit& unit, Cycle at, std::uint64_t vertex, const IssueSlot& slot,
                         Cycle result) {
  const auto found = open_.find({unit.number(), vertex});
  if (found == open_.end()) return;  // taken behind the window
  if (at > window_.last) {
    open_.erase(found);
    return;
  }
  OpenVertex& open = found->second;
  if (at >= window_.first && !add_row(unit, at, open, slot, result)) return stop();
  open.next = at + 1;
  if (--open.slots_left == 0) open_.erase(found);
}

// False: it does not fit.
bool PipelineLog::add_row(const VertexUnit& unit, Cycle at, const OpenVertex& open, const IssueSlot& slot,
                          Cycle result) {
  const auto row = std::make_shared<Row>(Row{unit.number(), label(unit, open.number, slot)});
  bytes_ += row->label.size() + kBytesBesideLabel;
  const Cycle since = std::max(open.next, window_.first);
  if (bytes_ > window_.most_bytes) {
    cut_at_ = since;
    return false;
  }
  const bool waits = since < at;
  if (waits) waiting_.emplace(since, Event{row, Stage::waits, true});
  waiting_.emplace(at, Event{row, Stage::issues, !waits});
  waiting_.emplace(result, Event{row, Stage::ends, false});
  return true;
}

void PipelineLog::write_before(Cycle cycle) {
  while (!waiting_.empty() && waiting_.begin()->first < cycle) {
    write(waiting_.begin()->first, waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
}

void PipelineLog::write(Cycle cycle, const Event& event) {
  if (!is_begun_) {
    out_ << "C=\t" << cycle << '\n';
  } else if (cycle != at_) {
    out_ << "C\t" << cycle - at_ << '\n';
  }
  is_begun_ = true;
  at_ = cycle;
  Row& row = *event.row;
  if (event.is_first) {
    row.id = rows_++;
    out_ << "I\t" << row.id << '\t' << row.id << '\t' << row.unit << "\nL\t" << row.id << "\t0\t" << row.label
         << '\n';
  }
  switch (event.stage) {
    case Stage::waits:
      out_ << "S\t" << row.id << "\t0\tW\n";
      break;
    case Stage::issues:
      if (!event.is_first) out_ << "E\t" << row.id << "\t0\tW\n";
      out_ << "S\t" << row.id << "\t0\tX\n";
      break;
    case Stage::ends:
      out_ << "E\t" << row.id << "\t0\tX\nR\t" << row.id << '\t' << retired_++ << "\t0\n";
      break;
  }
}

void PipelineLog::stop() {
  for (VertexUnit* unit : units_) unit->watch(nullptr);
  open_.clear();
}

void PipelineLog::end(const Result&) {
  stop();
  write_before(kNever);
}

}  // namespace splatscope::sim
