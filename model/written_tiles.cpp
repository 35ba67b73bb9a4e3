#include "model/written_tiles.h"

#include <cstring>

namespace splatscope {
namespace {

constexpr std::size_t kSpan = raster::kWindow / kFrameTileEdge + 1;  // tiles that a window touches, a side

// The pixels of a window within each of its tiles along one side, by the pixel that the window begins with.
struct TileMasks {
  std::uint64_t columns[kFrameTileEdge][kSpan], rows[kFrameTileEdge][kSpan];
};
constexpr TileMasks make_masks() {
  TileMasks masks{};
  for (std::size_t first = 0; first < kFrameTileEdge; ++first) {
    for (unsigned bit = 0; bit < 64; ++bit) {
      const auto x = static_cast<std::size_t>(raster::Window::x_of(bit)),
                 y = static_cast<std::size_t>(raster::Window::y_of(bit));
      masks.columns[first][(first + x) / kFrameTileEdge] |= std::uint64_t{1} << bit;
      masks.rows[first][(first + y) / kFrameTileEdge] |= std::uint64_t{1} << bit;
    }
  }
  return masks;
}
constexpr TileMasks kMasks = make_masks();

// Whether the first kSpan of four tiles in a row are written, in each of kSpan rows.
bool all_written(const std::uint8_t* tiles, std::size_t stride) {
  std::uint32_t all = ~0u;
  for (std::size_t row = 0; row < kSpan; ++row) {
    std::uint32_t four;
    std::memcpy(&four, tiles + row * stride, sizeof four);
    all &= four;
  }
  return (all & 0x010101u) == 0x010101u;
}

}  // namespace

WrittenTiles::WrittenTiles(std::uint32_t width, std::uint32_t height)
    : across_((width + kFrameTileEdge - 1) / kFrameTileEdge),
      stride_(across_ + kSpan),
      written_(stride_ * ((height + kFrameTileEdge - 1) / kFrameTileEdge + kSpan), 0) {}

void WrittenTiles::note(std::span<const raster::Window> windows, std::uint32_t triangle,
                        std::vector<TileWritten>& out) {
  for (const raster::Window& window : windows) {
    const auto x = static_cast<std::size_t>(window.x), y = static_cast<std::size_t>(window.y);
    std::uint8_t* tiles = &written_[y / kFrameTileEdge * stride_ + x / kFrameTileEdge];
    if (all_written(tiles, stride_)) continue;  // nearly always
    for (std::size_t row = 0; row < kSpan; ++row) {
      for (std::size_t column = 0; column < kSpan; ++column) {
        std::uint8_t& written = tiles[row * stride_ + column];
        const std::uint64_t in_tile =
            kMasks.columns[x % kFrameTileEdge][column] & kMasks.rows[y % kFrameTileEdge][row];
        if (written != 0 || (window.passed & in_tile) == 0) continue;
        written = 1;
        out.push_back({triangle, static_cast<std::uint32_t>((y / kFrameTileEdge + row) * across_ +
                                                            x / kFrameTileEdge + column)});
      }
    }
  }
}

}  // namespace splatscope
