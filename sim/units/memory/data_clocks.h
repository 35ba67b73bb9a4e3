#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "sim/kernel/cycle.h"

namespace splatscope::sim {

// The clocks in which a data bus carries data. Transfers are booked ahead, in order, one after the other.
class DataClocks {
 public:
  // At `now`: from `first` up to `last`, where none booked before is later.
  void book(Cycle now, Cycle first, Cycle last) {
    while (!ahead_.empty() && ahead_.front().last <= now) ahead_.pop_front();
    ahead_.push_back({first, last});
    booked_ += last - first;
  }
  // Those before `now`.
  std::uint64_t until(Cycle now) const {
    std::uint64_t clocks = booked_;
    for (const Transfer& transfer : ahead_)
      clocks -= transfer.last - std::clamp(now, transfer.first, transfer.last);
    return clocks;
  }

 private:
  struct Transfer {
    Cycle first, last;
  };
  std::deque<Transfer> ahead_;
  std::uint64_t booked_ = 0;
};

}  // namespace splatscope::sim
