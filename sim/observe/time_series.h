#pragma once

#include <iosfwd>
#include <vector>

#include "sim/kernel/observer.h"
#include "sim/simulate.h"

namespace splatscope::sim {

// A run as a table (CSV), a row for every so many core cycles, by the cycle before whose start it ends: of
// each unit the share of these cycles that it was busy and what its statistics grew by, of each channel the
// items that it holds at the row's end. Written as a stream.
class TimeSeries final : public Observer {
 public:
  // `interval`: core cycles a row, at least 1; rows end at its multiples, the last one with the run. `out`
  // outlives the series.
  TimeSeries(std::ostream& out, Cycle interval);

  void begin(const SimulatedMachine& machine) override;
  void booked(const Unit&, std::uint32_t, Cycle, Cycle) override {}
  Cycle sample(Cycle now) override;
  // Writes the rows since the machine's last act.
  void end(const Result& result) override;

 private:
  void rows(Cycle until);
  void row(Cycle end);

  std::ostream& out_;
  Cycle interval_;
  const SimulatedMachine* machine_ = nullptr;
  Cycle last_ = 0;                         // the last row's end
  std::vector<Cycle> busy_;                // of each unit, up to there
  std::vector<std::uint64_t> statistics_;  // of all units, up to there
};

}  // namespace splatscope::sim
