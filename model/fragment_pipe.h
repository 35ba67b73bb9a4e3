#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "model/draw.h"
#include "model/raster/interpolate.h"

namespace splatscope {

// Fragments on their way through the pixel unit, in order; full batches are shaded and given away.
class FragmentPipe {
 public:
  static constexpr std::size_t kCapacity = raster::kFragments;
  using Colors = std::array<const float*, 4>;  // r, g, b, a: an array each
  using Write = std::function<void(const Colors&, std::span<const std::uint32_t> pixels)>;

  // `width`: of the frame, in pixels.
  FragmentPipe(std::uint32_t width, const NumberFormats& formats);

  // From now on, with nothing in it, it takes fragments of this draw, until it is bound to the next.
  void bind(const DrawBindings& bindings);
  // And of pieces whose corners are these. `write` gets at most kCapacity fragments at a time.
  void begin(const raster::VertexAttributes& vertices, Write write);

  // The windows of one band of a piece, which stays where it is until all is flushed. `work`: where its quads
  // are noted, with the texel blocks that each one reads; or null.
  void push_band(const raster::Piece& piece, std::span<const raster::Window> windows, DrawWork* work);

  // Shades and gives away all there is.
  void flush();

 private:
  void push_window(const raster::Piece& piece, const raster::Window& window);
  void note_quads(const raster::Window& window);
  void sample(std::size_t count);
  void note_blocks(std::span<const std::uint32_t> blocks);

  const DrawBindings* bindings_ = nullptr;
  const raster::VertexAttributes* vertices_ = nullptr;
  std::uint32_t width_;
  const NumberFormats& formats_;
  DrawWork* work_ = nullptr;
  Write write_;
  bool samples_ = false;
  std::size_t count_ = 0;                                   // of fragments in the batch
  std::array<raster::FragmentsOfPiece, kCapacity> pieces_;  // that these are of, at least one each
  std::size_t piece_count_ = 0;
  alignas(64) std::array<std::uint32_t, raster::kFragmentStride> places_, pixels_;
  std::array<std::uint32_t, kCapacity + 4> quads_;    // of `work`, a fragment each
  alignas(64) raster::FragmentValues coordinates_{};  // of the sampled texture
  raster::FragmentAttributes attributes_{};           // in `batch_`, or the coordinates
  pixel::FragmentBatch batch_{};
};

}  // namespace splatscope
