#include "studies/measure.h"

#include <algorithm>
#include <cstddef>

namespace splatscope::studies {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double median_seconds(int repeats, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const auto start = HostClock::now();
    work();
    seconds.push_back(seconds_since(start));
  }
  return median(std::move(seconds));
}

}  // namespace splatscope::studies
