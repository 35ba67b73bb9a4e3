#include "model/written_tiles.h"

#include <bit>

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

}  // namespace

WrittenTiles::WrittenTiles(std::uint32_t width, std::uint32_t height)
    : across_((width + kFrameTileEdge - 1) / kFrameTileEdge),
      written_(std::size_t{across_} * ((height + kFrameTileEdge - 1) / kFrameTileEdge), 0) {}

void WrittenTiles::note(std::span<const raster::Window> windows, std::uint32_t triangle,
                        std::vector<TileWritten>& out) {
  for (const raster::Window& window : windows) {
    const auto x = static_cast<std::uint32_t>(window.x), y = static_cast<std::uint32_t>(window.y);
    const std::uint32_t left = x % kFrameTileEdge, top = y % kFrameTileEdge;
    for (std::uint64_t rest = window.passed; rest != 0;) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const std::uint32_t column =
                              (left + static_cast<std::uint32_t>(raster::Window::x_of(bit))) / kFrameTileEdge,
                          row =
                              (top + static_cast<std::uint32_t>(raster::Window::y_of(bit))) / kFrameTileEdge;
      rest &= ~(kMasks.columns[left][column] & kMasks.rows[top][row]);
      const std::uint32_t tile = (y / kFrameTileEdge + row) * across_ + x / kFrameTileEdge + column;
      if (written_[tile] != 0) continue;
      written_[tile] = 1;
      out.push_back({triangle, tile});
    }
  }
}

}  // namespace splatscope
