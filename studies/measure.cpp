#include "studies/measure.h"

#include <span>
#include <vector>

#include "traces/median.h"

namespace splatscope::studies {

double median_seconds(int repeats, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const auto start = HostClock::now();
    work();
    seconds.push_back(seconds_since(start));
  }
  return traces::median(std::span(seconds));
}

}  // namespace splatscope::studies
