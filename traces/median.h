#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>

namespace splatscope::traces {

// Of an even number of values the mean of the middle two; 0 of none. They are put in another order.
template <typename Number>
Number median(std::span<Number> values) {
  if (values.empty()) return 0;
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, upper);
  if (values.size() % 2 == 1) return *upper;
  return std::midpoint(*std::max_element(values.begin(), upper), *upper);
}

}  // namespace splatscope::traces
