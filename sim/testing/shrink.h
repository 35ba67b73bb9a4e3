#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

// Smaller failures: RapidCheck's own way through lists takes a number of tries that grows with the square of
// what must stay.
namespace splatscope::sim::testing {

using Choices = std::vector<std::uint32_t>;
using Fails = std::function<bool(const Choices&)>;

// Without each run of so many choices that it fails without, the last ones first.
inline void leave_out_runs(Choices& failing, std::size_t size, const Fails& fails, std::size_t& tries) {
  for (std::size_t end = failing.size(); end > 0 && tries > 0; --tries) {
    const std::size_t first = end > size ? end - size : 0;
    Choices fewer = failing;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(first),
                fewer.begin() + static_cast<std::ptrdiff_t>(end));
    if (fails(fewer)) failing = std::move(fewer);
    end = first;
  }
}

// The choice at `place`: 0, or the least power of two with which it fails.
inline void lower(Choices& failing, std::size_t place, const Fails& fails, std::size_t& tries) {
  const std::uint32_t given = failing[place];
  for (std::uint64_t low = 0; low < given && tries > 0; low = low == 0 ? 1 : 2 * low, --tries) {
    failing[place] = static_cast<std::uint32_t>(low);
    if (fails(failing)) return;
  }
  failing[place] = given;
}

// A list that fails too, by delta debugging (Zeller and Hildebrandt 2002): no single choice can be left out,
// and none be 0 or a lower power of two. Ends early when no `tries` are left.
inline Choices shrunk(Choices failing, const Fails& fails, std::size_t& tries) {
  for (Choices before; before != failing && tries > 0;) {
    before = failing;
    for (std::size_t size = failing.size(); size > 0; size /= 2) leave_out_runs(failing, size, fails, tries);
    for (std::size_t place = failing.size(); place-- > 0;) lower(failing, place, fails, tries);
  }
  return failing;
}

}  // namespace splatscope::sim::testing
