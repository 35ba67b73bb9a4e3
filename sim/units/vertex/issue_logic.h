#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/machine/machine.h"
#include "sim/kernel/cycle.h"
#include "sim/units/vertex/issue_slots.h"

namespace splatscope::sim {

// What was issued in a cycle.
struct Issued {
  int thread = 0;
  std::uint32_t slot = 0;
  bool is_last = false;  // slot of its vertex
  Cycle result = 0;      // of a last slot: cycles to the last result of the vertex
};

// The issue logic of a vertex unit, cycle by cycle. A unit has `vertex.threads` threads, each of which holds
// one vertex. In a cycle at most one of them issues one slot: the first one in turn, after the one that
// issued last, whose operands are there and for whose scalar instruction the scalar unit is free. (In turn,
// not oldest first: threads are there to hide latency, and turns keep them apart by as much as they can be.)
// After a vertex's last slot its thread issues nothing for `vertex.reload_cycles`.
//
// All times are counted from the coming cycle on, so that two equal objects go on in the same way.
class IssueLogic {
 public:
  // At rest: no thread holds a vertex. `slots`: of the program, at least one; they outlive this.
  IssueLogic(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec);

  // The coming cycle: issues what can be.
  std::optional<Issued> issue();

  // Cycles to pass until a thread can take a vertex, which issues from the coming cycle on; kNever: all hold
  // one.
  Cycle next_free() const;
  // Gives a vertex to the lowest thread that can take one. ModelError where next_free() is not 0.
  int take();

  int held() const { return held_; }  // vertices with slots to issue
  bool is_at_rest() const;            // nothing changes unless a vertex is taken

  bool operator==(const IssueLogic& other) const;
  std::size_t hash() const;

 private:
  // Counts down from a latency or reload_cycles, and one more.
  using Countdown = std::uint8_t;
  struct Thread {
    std::uint16_t slot = 0;                     // the next to issue; the number of slots: no vertex
    Countdown reload = 0;                       // until it can take a vertex
    Countdown result = 0;                       // until the last result of the slots issued
    std::array<Countdown, kRegisters> ready{};  // until the last result of each register
    bool operator==(const Thread&) const = default;
  };

  bool can_issue(const Thread& thread) const;
  Issued issue(int number);
  void pass_cycle();

  const std::vector<IssueSlot>* slots_;
  Countdown vector_latency_, scalar_latency_, scalar_interval_, reload_cycles_;
  std::vector<Thread> threads_;
  int turn_ = 0;
  int held_ = 0;
  Countdown scalar_free_ = 0;
};

struct IssueLogicHash {
  std::size_t operator()(const IssueLogic& logic) const { return logic.hash(); }
};

}  // namespace splatscope::sim
