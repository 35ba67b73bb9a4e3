#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/isa/program.h"
#include "model/machine/machine.h"
#include "sim/kernel/cycle.h"
#include "sim/units/vertex/issue_slots.h"

// When a vertex unit issues the instructions of a group of vertices. A vs_1_1 program has no branches and
// touches no memory, so this is a function of the program, the size of the group and the unit's parameters
// alone.
namespace splatscope::sim {

// The issue logic of a unit, cycle by cycle: the threads (vertices) of a group take turns, and each cycle the
// first one in turn issues whose operands are there, and for whose scalar instruction the scalar unit is
// free.
class IssueLogic {
 public:
  IssueLogic(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec);

  // A group of 1 to `vertex.threads` vertices, its first cycle the next call of issue().
  void start(int vertices);
  // One cycle. Returns the thread that issued, or -1.
  int issue();
  bool done() const { return left_ == 0; }
  // Cycles from the start to the one in which the next group may issue, once done.
  Cycle issue_cycles() const { return now_; }
  Cycle last_result() const { return last_result_; }  // cycles from the start to the last result

 private:
  struct Thread {
    std::size_t slot = 0;
    std::array<Cycle, kRegisters> ready{};  // when the last result of each register is there
  };
  bool can_issue(const Thread& thread, const IssueSlot& slot) const;
  void record(Thread& thread, ComponentMask writes, Cycle latency);

  const std::vector<IssueSlot>* slots_;
  Cycle vector_latency_, scalar_latency_, scalar_interval_;
  std::vector<Thread> threads_;
  std::size_t vertices_ = 0;
  std::size_t turn_ = 0;
  std::size_t left_ = 0;  // slots still to issue, of all threads
  Cycle now_ = 0;
  Cycle scalar_free_ = 0;
  Cycle last_result_ = 0;
};

// A group from its first issue on.
struct GroupSchedule {
  Cycle issue_cycles = 0;   // until another may issue
  Cycle result_cycles = 0;  // until its last result
};

// Schedules of groups of 1, 2, ... `vertex.threads` vertices, in that order.
std::vector<GroupSchedule> group_schedules(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec);

// Clocks a vertex of full groups one after the other.
double clocks_per_vertex(const isa::Program& program, const Machine::Vertex& spec);

}  // namespace splatscope::sim
