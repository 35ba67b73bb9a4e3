#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "model/draw.h"
#include "model/raster/interpolate.h"

namespace splatscope {

// Fragments on their way through the pixel unit, in order; full batches are shaded and given away.
class FragmentPipe {
 public:
  static constexpr std::size_t kCapacity = raster::FragmentPlaces::kCapacity;
  using Colors = std::array<const float*, 4>;  // r, g, b, a: an array each
  using Write = std::function<void(const Colors&, std::span<const std::uint32_t> pixels)>;

  // `frame`: its size and formats. `write` gets at most kCapacity fragments at a time.
  FragmentPipe(const DrawBindings& bindings, const Frame& frame, Write write);

  // Begins a piece of a triangle, which stays where it is until the next one begins or all is flushed.
  // `work`: where its quads are noted, with the texel blocks that each one reads; or null.
  void begin(std::size_t piece, const raster::TriangleSetup& setup,
             const std::array<const raster::Attributes*, 3>& corners, DrawWork* work);
  bool began(std::size_t piece) const { return piece_ == piece; }

  // The windows of one band of the piece.
  void push_band(std::span<const raster::Window> windows);

  // Shades and gives away all there is.
  void flush_all();

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void interpolate();
  void flush();
  void push_rows(std::span<const raster::Window> windows, unsigned first_row, unsigned end_row);
  void note_quads(std::span<const raster::Window> windows, unsigned first_row, unsigned end_row);
  void sample(std::size_t count);
  void note_blocks(std::span<const std::uint32_t> blocks);

  const DrawBindings& bindings_;
  std::uint32_t width_;
  const NumberFormats& formats_;
  DrawWork* work_ = nullptr;
  Write write_;
  bool samples_ = false;
  std::size_t piece_ = kNone;
  const raster::TriangleSetup* setup_ = nullptr;
  std::array<const raster::Attributes*, 3> corners_{};
  std::size_t count_ = 0;         // of fragments in the batch
  std::size_t interpolated_ = 0;  // of these, the first that are
  raster::FragmentPlaces places_;
  std::array<std::uint32_t, kCapacity + 4> quads_;    // of `work`, a fragment each
  alignas(64) raster::FragmentValues coordinates_{};  // of the sampled texture
  raster::FragmentAttributes attributes_{};           // in `batch_`, or the coordinates
  pixel::FragmentBatch batch_{};
};

}  // namespace splatscope
