#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace splatscope::kernels {

struct RowRange {
  int top = 0, bottom = 0;  // bottom excluded; empty where it is not below the top
};

// A picture cut into bands of rows, each of which one thread fills: the splats that touch a band, in their
// order. What a pixel adds up is then the same for any number of threads.
class RowBands {
 public:
  static constexpr int kRows = 16;             // of a band
  static constexpr std::size_t kChunk = 4096;  // splats, sorted into bands together

  int count() const { return bands_; }
  RowRange rows(int band) const { return {band * kRows, std::min(height_, (band + 1) * kRows)}; }

  // `prepare(k)`, called in parallel, gets splat k ready and returns its rows within the picture.
  template <class Prepare>
  RowBands(int height, std::size_t splats, const Prepare& prepare)
      : height_(height), bands_((height + kRows - 1) / kRows), chunks_((splats + kChunk - 1) / kChunk) {
    oneapi::tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t chunk) {
      sort(chunk * kChunk, std::min(splats, (chunk + 1) * kChunk), prepare, chunks_[chunk]);
    });
  }

  // `fill(band)` for every band, in parallel.
  template <class Fill>
  void for_each_band(const Fill& fill) const {
    oneapi::tbb::parallel_for(0, bands_, fill);
  }

  // `visit(k)` for every splat that touches the band, k rising.
  template <class Visit>
  void for_each_splat(int band, const Visit& visit) const {
    const auto b = static_cast<std::size_t>(band);
    for (const Chunk& chunk : chunks_) {
      for (std::uint32_t i = chunk.first[b]; i < chunk.first[b + 1]; ++i) visit(std::size_t{chunk.splats[i]});
    }
  }

 private:
  struct Chunk {
    std::vector<std::uint32_t> first;  // of each band in `splats`, and the end
    std::vector<std::uint32_t> splats;
  };

  template <class Prepare>
  void sort(std::size_t begin, std::size_t end, const Prepare& prepare, Chunk& chunk) const {
    std::vector<RowRange> rows;
    rows.reserve(end - begin);
    chunk.first.assign(static_cast<std::size_t>(bands_) + 1, 0);
    const auto for_bands = [](const RowRange& range, const auto& visit) {
      if (range.top >= range.bottom) return;
      for (int b = range.top / kRows; b <= (range.bottom - 1) / kRows; ++b)
        visit(static_cast<std::size_t>(b));
    };
    for (std::size_t k = begin; k < end; ++k) {
      rows.push_back(prepare(k));
      for_bands(rows.back(), [&](std::size_t b) { ++chunk.first[b + 1]; });
    }
    for (std::size_t b = 1; b < chunk.first.size(); ++b) chunk.first[b] += chunk.first[b - 1];
    chunk.splats.resize(chunk.first.back());
    std::vector<std::uint32_t> next(chunk.first.begin(), chunk.first.end() - 1);
    for (std::size_t k = begin; k < end; ++k) {
      for_bands(rows[k - begin],
                [&](std::size_t b) { chunk.splats[next[b]++] = static_cast<std::uint32_t>(k); });
    }
  }

  int height_, bands_;
  std::vector<Chunk> chunks_;
};

}  // namespace splatscope::kernels
