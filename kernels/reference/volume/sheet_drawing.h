#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/reference/row_bands.h"
#include "kernels/reference/volume/volume_splats.h"
#include "kernels/view.h"
#include "model/stop.h"

namespace splatscope::kernels {

inline constexpr std::size_t kSplatsAtOnce = 1 << 15;  // about: they stay in the cache between the two steps

// What was drawn: splats that cover a pixel's centre, and the sheets that have such.
struct SheetsDrawn {
  std::size_t splats = 0;
  std::size_t sheets = 0;
};

// Draws sheets from back to front, several at a time, so that their projected splats need little memory.
// `prepare(numbers, sheets, splats, rows)` projects the splats of the given numbers into `splats`, where it
// may leave some out, writes their rows, and returns how many they are; `Splat::sheet` is that of `sheets`.
// `bands[i].add(splats, places)` adds splats to the sheet, `bands[i].composite()` puts it over the picture
// and clears it. `progress` is told the fraction done.
template <class Splat, class Band, class Prepare>
SheetsDrawn draw_sheets(const View& view, const SheetOrder& order, bool last_is_nearest,
                        std::vector<Band>& bands, const std::function<void(double)>& progress,
                        const Prepare& prepare) {
  std::vector<Splat> splats;
  std::vector<std::uint32_t> numbers, sheets;
  const std::size_t count = order.first.size() - 1;
  std::vector<char> touched(count, 0);  // of each sheet
  std::size_t drawn = 0, done = 0;
  const auto flush = [&] {
    splats.resize(numbers.size() + RowBands::kChunk);
    const RowBands rows(
        view.height, numbers.size(), [&](std::size_t begin, std::size_t end, RowRange* ranges) {
          return prepare(std::span(numbers).subspan(begin, end - begin),
                         std::span(sheets).subspan(begin, end - begin), splats.data() + begin, ranges);
        });
    drawn += rows.kept();
    rows.for_each_band([&](int index) {
      Band& band = bands[static_cast<std::size_t>(index)];
      std::uint32_t sheet = 0;
      rows.for_each_run(index, [&](std::span<const std::uint32_t> run) {
        while (!run.empty()) {
          stop_if_asked();
          if (splats[run.front()].sheet != sheet) band.composite();
          sheet = splats[run.front()].sheet;
          std::atomic_ref(touched[sheet]).store(1, std::memory_order_relaxed);
          const auto end = std::ranges::find_if(run, [&](auto k) { return splats[k].sheet != sheet; });
          const std::size_t same = static_cast<std::size_t>(end - run.begin());
          band.add(splats, run.first(same));
          run = run.subspan(same);
        }
      });
      band.composite();
    });
    done += numbers.size();
    if (progress) progress(static_cast<double>(done) / static_cast<double>(order.splats.size()));
    numbers.clear();
    sheets.clear();
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t sheet = last_is_nearest ? i : count - 1 - i;
    const auto begin = order.splats.begin() + order.first[sheet],
               end = order.splats.begin() + order.first[sheet + 1];
    if (numbers.size() + static_cast<std::size_t>(end - begin) > kSplatsAtOnce && !numbers.empty()) flush();
    numbers.insert(numbers.end(), begin, end);
    sheets.resize(numbers.size(), static_cast<std::uint32_t>(sheet));
  }
  if (!numbers.empty()) flush();
  return {drawn, static_cast<std::size_t>(std::ranges::count(touched, 1))};
}

}  // namespace splatscope::kernels
