#include "sim/observe/time_series.h"

#include <ostream>

#include "sim/machine.h"

namespace splatscope::sim {

TimeSeries::TimeSeries(std::ostream& out, Cycle interval) : out_(out), interval_(interval) {}

void TimeSeries::begin(const SimulatedMachine& machine) {
  machine_ = &machine;
  out_ << "cycle";
  for (const auto& unit : machine.units) {
    out_ << ',' << unit->name() << ".busy";
    for (const Statistic& statistic : unit->statistics(0)) {
      out_ << ',' << unit->name() << '.' << statistic.name;
      statistics_.push_back(0);
    }
  }
  for (const auto& channel : machine.channels) out_ << ',' << channel->name() << ".items";
  out_ << '\n';
  busy_.resize(machine.units.size());
}

void TimeSeries::row(Cycle end) {
  out_ << end;
  std::size_t unit = 0, statistic = 0;
  for (const ClockDomain* domain : {&machine_->core, &machine_->bus}) {
    for (std::size_t place = 0; place < domain->units().size(); ++place, ++unit) {
      const Cycle busy = domain->busy(place, end);
      out_ << ',' << static_cast<double>(busy - busy_[unit]) / static_cast<double>(end - last_);
      busy_[unit] = busy;
      for (const Statistic& entry : domain->units()[place]->statistics(domain->first_at(end))) {
        out_ << ',' << entry.value - statistics_[statistic];
        statistics_[statistic++] = entry.value;
      }
    }
  }
  for (const auto& channel : machine_->channels) out_ << ',' << channel->items();
  out_ << '\n';
  last_ = end;
}

// Whatever the machine did since its last act belongs to the rows that end at or before `until`: what it is
// now, it was at the end of each of them, and a unit that was busy then was busy through them.
void TimeSeries::rows(Cycle until) {
  while (last_ + interval_ <= until) row(last_ + interval_);
}

Cycle TimeSeries::sample(Cycle now) {
  rows(now);
  return last_ + interval_;
}

void TimeSeries::end(const Result& result) {
  rows(result.cycles);
  if (result.cycles > last_) row(result.cycles);
}

}  // namespace splatscope::sim
