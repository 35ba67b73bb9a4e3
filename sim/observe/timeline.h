#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "model/command/commands.h"
#include "sim/kernel/observer.h"
#include "sim/observe/log_window.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// A run as a timeline in Chrome's trace event format, which Perfetto opens: a track for the commands and one
// for each unit (busy, starved, blocked by whom; idle is left empty), counters for the items in each channel
// and for the use of each memory channel's data bus. One microsecond there is one core cycle. Written as a
// stream; beside the names of its tracks no longer than `LogWindow::most_bytes`.
class Timeline final : public Observer {
 public:
  // `trace` is what will be simulated. `out` and `trace` outlive the timeline.
  Timeline(std::ostream& out, const Trace& trace, const LogWindow& window);

  void begin(const SimulatedMachine& machine) override;
  void booked(const Unit& unit, std::uint32_t book, Cycle from, Cycle until) override;
  Cycle sample(Cycle now) override;
  // Writes the commands' track and the end of the text.
  void end(const Result& result) override;

  // What was known here is shown, and what begins later is not: it did not fit into `most_bytes`. kNever:
  // everything did.
  Cycle cut_at() const { return cut_at_; }

 private:
  struct Counter {
    std::string middle;       // of its events, between cycle and value
    std::uint64_t value = 0;  // of the last event
  };

  // An event: three pieces of text about two numbers.
  void append(std::string_view head, std::uint64_t first, std::string_view middle, std::uint64_t second,
              std::string_view tail);
  // The same of one that begins at `first`, as long as there is room. The first for which there is none is
  // known at `now`: all that comes later is cut.
  void write(std::string_view head, Cycle first, std::string_view middle, std::uint64_t second,
             std::string_view tail, Cycle now);
  bool clip(Cycle& from, Cycle& until) const;
  void count(Counter& counter, std::uint64_t value, Cycle at, Cycle now);
  void count_buses(Cycle now);
  void flush();

  std::ostream& out_;
  const Trace& trace_;
  LogWindow window_;
  const SimulatedMachine* machine_ = nullptr;
  std::vector<std::string> slice_heads_;  // by unit
  std::vector<std::string> slice_tails_;  // by book
  std::vector<Counter> channels_, buses_;
  std::vector<std::uint64_t> data_clocks_;  // of each memory channel at the last sample
  Cycle sampled_at_ = 0, next_sample_ = 0;
  std::vector<char> buffer_;
  std::size_t used_ = 0;     // of it, not written yet
  std::uint64_t bytes_ = 0;  // of all events so far
  // For them: until the end of the run without what is kept for the commands, and up to a cut also without
  // what is kept for the slices that are open there.
  std::uint64_t room_ = 0, room_behind_cut_ = 0;
  Cycle cut_at_ = kNever;
};

}  // namespace splatscope::sim
