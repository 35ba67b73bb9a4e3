#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/stop.h"

namespace splatscope::kernels {

struct RowRange {
  int top = 0,
      bottom = 0;  // bottom excluded; empty where it is not below the top
};

// A picture cut into bands of rows, each of which one thread fills: the splats that touch a band, in their
// order. What a pixel adds up is then the same for any number of threads.
class RowBands {
 public:
  static constexpr int kRows = 16;             // of a band
  static constexpr std::size_t kChunk = 4096;  // splats, sorted into bands together

  int count() const { return bands_; }
  RowRange rows(int band) const { return {band * kRows, std::min(height_, (band + 1) * kRows)}; }

  // `prepare(begin, end, rows)`, called in parallel, gets splats `begin` to `end` ready: it may leave some
  // out and number the others anew from `begin` on, writes their rows within the picture to `rows`, and
  // returns how many they are.
  template <class Prepare>
  RowBands(int height, std::size_t splats, const Prepare& prepare)
      : height_(height), bands_((height + kRows - 1) / kRows), chunks_((splats + kChunk - 1) / kChunk) {
    oneapi::tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t chunk) {
      stop_if_asked();
      const std::size_t begin = chunk * kChunk, end = std::min(splats, begin + kChunk);
      std::vector<RowRange> rows(end - begin);
      rows.resize(prepare(begin, end, rows.data()));
      sort(begin, rows, chunks_[chunk]);
    });
  }

  // Splats that were not left out.
  std::size_t kept() const {
    std::size_t sum = 0;
    for (const Chunk& chunk : chunks_) sum += chunk.kept;
    return sum;
  }

  // `fill(band)` for every band, in parallel.
  template <class Fill>
  void for_each_band(const Fill& fill) const {
    oneapi::tbb::parallel_for(0, bands_, [&](int band) {
      stop_if_asked();
      fill(band);
    });
  }

  // `visit(splats)` with the numbers of the splats that touch the band, rising, a run after the other.
  template <class Visit>
  void for_each_run(int band, const Visit& visit) const {
    const auto b = static_cast<std::size_t>(band);
    for (const Chunk& chunk : chunks_) {
      visit(std::span(chunk.splats).subspan(chunk.first[b], chunk.first[b + 1] - chunk.first[b]));
    }
  }

 private:
  struct Chunk {
    std::size_t kept = 0;
    std::vector<std::uint32_t> first;  // of each band in `splats`, and the end
    std::vector<std::uint32_t> splats;
  };

  void sort(std::size_t begin, std::span<const RowRange> rows, Chunk& chunk) const {
    chunk.kept = rows.size();
    chunk.first.assign(static_cast<std::size_t>(bands_) + 1, 0);
    const auto for_bands = [](const RowRange& range, const auto& visit) {
      if (range.top >= range.bottom) return;
      for (int b = range.top / kRows; b <= (range.bottom - 1) / kRows; ++b)
        visit(static_cast<std::size_t>(b));
    };
    for (const RowRange& range : rows) {
      for_bands(range, [&](std::size_t b) { ++chunk.first[b + 1]; });
    }
    for (std::size_t b = 1; b < chunk.first.size(); ++b) chunk.first[b] += chunk.first[b - 1];
    chunk.splats.resize(chunk.first.back());
    std::vector<std::uint32_t> next(chunk.first.begin(), chunk.first.end() - 1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for_bands(rows[i],
                [&](std::size_t b) { chunk.splats[next[b]++] = static_cast<std::uint32_t>(begin + i); });
    }
  }

  int height_, bands_;
  std::vector<Chunk> chunks_;
};

}  // namespace splatscope::kernels
