#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/draw.h"
#include "model/raster/interpolate.h"

namespace splatscope {

// Fragments on their way through the pixel unit, in order; full batches are shaded and written.
class FragmentPipe {
 public:
  // `work`: where the texel blocks that each quad reads are noted, in the quad and in `texel_blocks`; or
  // null.
  FragmentPipe(const DrawBindings& bindings, Frame& frame, DrawWork* work);

  // Begins a piece of a triangle, which stays where it is until the next one or the end.
  void begin(const raster::TriangleSetup& setup, const std::array<const raster::Attributes*, 3>& corners);

  // The pixels of a quad that passed the depth test: `passed` is not 0. (x, y): first pixel of the quad.
  // `work` has its record last.
  void push_quad(int x, int y, unsigned passed);

  // Interpolates what waits of the last piece.
  void end();
  // Shades and writes all there is.
  void flush();

 private:
  void sample(std::size_t count);
  void note_blocks(std::span<const std::uint32_t> blocks);

  const DrawBindings& bindings_;
  Frame& frame_;
  DrawWork* work_;
  bool samples_ = false;
  const raster::TriangleSetup* setup_ = nullptr;
  std::array<const raster::Attributes*, 3> corners_{};
  std::size_t count_ = 0;         // of fragments in the batch
  std::size_t interpolated_ = 0;  // of these, the first that are
  raster::FragmentPlaces places_;
  raster::FragmentAttributes attributes_{};
  std::array<std::uint32_t, raster::FragmentPlaces::kStride> pixels_;
  std::array<std::uint32_t, raster::FragmentPlaces::kStride> quads_;  // of `work`
  pixel::FragmentBatch batch_{};
};

}  // namespace splatscope
