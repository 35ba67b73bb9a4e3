#pragma once

#include <unordered_map>
#include <vector>

#include "sim/units/vertex/issue_logic.h"

namespace splatscope::sim {

// The issue logic, each stretch of which is worked out once and replayed after that: a vs_1_1 program has no
// branches and touches no memory, so how a state of the logic goes on depends on the state alone. States are
// numbered in a table as they occur; of each the table has where the next end of a vertex leads, where taking
// a vertex leads, and where letting some cycles pass leads. A steady stream goes round a few states; what has
// not occurred yet is issued cycle by cycle. A full table is emptied, and fills again from the state at hand.
class IssueReplay {
 public:
  struct NextEnd {
    Cycle cycles = kNever;  // up to and with the one that issues the vertex's last slot; kNever: none held
    Issued issued;          // that slot
  };

  // At rest. `most_states`: of the table, at least 2.
  IssueReplay(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec,
              std::size_t most_states = 4096);
  IssueReplay(IssueReplay&&) = default;
  IssueReplay(const IssueReplay&) = delete;  // entries point into the table

  const IssueLogic& logic() const { return entries_[at_].state->first; }
  void rest();  // back to where it began

  // The next vertex to end if none is taken before.
  NextEnd next_end();
  void pass_next_end();
  // Fewer cycles than to the next end.
  void pass(Cycle cycles);
  // As IssueLogic's.
  int take();

  std::size_t states() const { return entries_.size(); }

 private:
  using Number = std::uint32_t;
  using Table = std::unordered_map<IssueLogic, Number, IssueLogicHash>;
  struct Entry {
    const Table::value_type* state;
    NextEnd next_end;
    Number after_end = kUnknown;
    int taken_by = -1;
    Number after_taking = kUnknown;
  };
  static constexpr Number kUnknown = ~Number{0};
  static constexpr Cycle kLongest = 128;  // no countdown of the logic is longer

  void make_room();
  Number number(const IssueLogic& logic);

  IssueLogic rest_;
  std::size_t most_states_;
  Table table_;
  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, Number> passed_;  // by state * kLongest + cycles - 1
  Number at_ = 0;
};

}  // namespace splatscope::sim
